//! The chain verdict of a queue, and of a scenario's chain.

use crate::stiffness::stiffness;
use crate::{ChainOfRobots, Team, Verdict, chain};
use trench_formation::trench::Trench;
use trench_formation::zoning::Radii;
use trench_plan::{Plan, QueuePlan};

/// The chain bound, for robots that start within the queue's tolerance of a place: nobody may reach zone 1 of the one ahead, or under
/// the queue law, which has no zones, its body. So no error in the distance to the one ahead may exceed the spacing less that.
pub(crate) fn growth(subject: &str, plan: &Plan, queue: &QueuePlan, team: &Team) -> Option<Verdict> {
    let gains = team.chain_gains?;
    let robots = queue.places.len();
    let (spacing, forbidden, acceleration) = match team.zones {
        // Zones, not the spacing of places, say where a chain comes to rest.
        Some([rho_underbar, rho_hat, rho, ..]) => {
            (queue.chain.map_or(rho_hat, |chain| chain.spacing).min(rho), rho_underbar, None)
        }
        None => (least_spacing(queue)?, 2.0 * (team.radius + team.margin), Some(team.acceleration)),
    };
    let of = ChainOfRobots {
        instead_of: (team.law != "queue").then_some(team.law.as_str()),
        robots,
        gains,
        initial_error: queue.tolerance,
        by_rank: &[],
        setting_out: if moves(queue) { plan.motion.speed } else { 0.0 },
        tolerance: spacing - forbidden,
        acceleration,
    };
    (robots > 1).then(|| chain(&format!("{subject}, queue {}", queue.name), &of))
}

/// The chain bound of robots that have come to rest in the middle of the neutral zone, each disturbed by half the zone's width, as a
/// note where somebody may reach zone 1. Nothing of one robot, or of trenches that have no stiffness at their bottom.
pub(crate) fn growth_at_rest(
    subject: &str,
    law: &str,
    (trench, damping): (&dyn Trench, f64),
    radii: &Radii,
    robots: usize,
) -> Option<Verdict> {
    if robots < 2 {
        return None;
    }
    let half = 0.5 * (radii.rho - radii.rho_hat);
    let of = ChainOfRobots {
        instead_of: Some(law),
        robots,
        gains: (stiffness(trench)?, damping),
        initial_error: half,
        by_rank: &[],
        setting_out: 0.0,
        tolerance: radii.rho_hat + half - radii.rho_underbar,
        acceleration: None,
    };
    let found = chain(subject, &of);
    Some(Verdict { holds: true, note: !found.holds, ..found })
}

/// Whether its goal points go along the segment.
fn moves(queue: &QueuePlan) -> bool {
    queue.places.iter().any(|place| place.start != place.end)
}

/// The least distance of two of its places, at their starts or ends, m; none of one place.
fn least_spacing(queue: &QueuePlan) -> Option<f64> {
    let of = |ends: bool| {
        let at = |index: usize| {
            let place = &queue.places[index];
            queue.curve.at(if ends { place.end } else { place.start }).point
        };
        let pairs = (0..queue.places.len()).flat_map(|index| (0..index).map(move |other| (index, other)));
        pairs.map(move |(index, other)| (at(index) - at(other)).norm()).min_by(f64::total_cmp)
    };
    of(true).zip(of(false)).map(|(ends, starts)| ends.min(starts))
}
