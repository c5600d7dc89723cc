//! A scenario file: gains, potentials, zones, directions of attraction, room, chains.

use crate::clearance::clearance;
use crate::connection::connection;
use crate::damping::chain_damping;
use crate::damping_of_scenario::{damped_directed, damped_nearest};
use crate::goal::goal;
use crate::goal_among_obstacles::goal_among_obstacles;
use crate::growth::growth_at_rest;
use crate::limits::{Largest, of_scenario};
use crate::passing::{fragments_at, room_on_the_way};
use crate::potential::potential;
use crate::queue_of_scenario::{goal_of_queue, queue};
use crate::room::room;
use crate::separation_of_goals::separation_of_goals;
use crate::separation_of_queue::separation_of_queue;
use crate::starts_of_scenario::{starts_of_directed, starts_of_nearest};
use crate::step_of_scenario::step;
use crate::stiffness::steepest;
use crate::stopping_of_scenario::{stopping_of_chain, stopping_of_goals, stopping_of_queue};
use crate::transits::transits;
use crate::verdict::number;
use crate::walls_of_scenario::{walls_of_directed, walls_of_nearest};
use crate::zones::zones;
use crate::{Approach, Verdict, direction, gains};
use trench_formation::Vector2;
use trench_formation::agent::Method;
use trench_formation::curve::Placed;
use trench_formation::kinematics::PointState;
use trench_formation::laws::{Capability, Family, Robust};
use trench_formation::simulate::ChainScenario;
use trench_formation::trench::{AnyDamping, AnyTrench, Damping, SaturatedDamping};
use trench_scenario::{ChosenLaw, Directed, GoalLaw, Scenario, Task};

/// Trenches are looked at up to this distance, m.
pub(crate) const RANGE: f64 = 100.0;

/// Judges a simulation before it runs. Scenarios of launch files have nothing of their own: check the launch file.
pub fn scenario(subject: &str, scenario: &Scenario) -> Vec<Verdict> {
    let mut verdicts = of_task(subject, scenario);
    verdicts.extend(step(subject, scenario));
    verdicts
}

fn of_task(subject: &str, scenario: &Scenario) -> Vec<Verdict> {
    match &scenario.task {
        Task::Regulating(task) => {
            task.cases.iter().flat_map(|case| law(&named(subject, &case.name), case.law)).collect()
        }
        Task::GoalTracking(task) => {
            let laws = task.cases.iter().filter_map(|case| match &case.law {
                GoalLaw::Trench(law) => Some((named(subject, &case.name), law, case.bounds)),
                GoalLaw::Conventional(_) | GoalLaw::Velocity(_) => None,
            });
            laws.flat_map(|(name, law, bounds)| {
                let (finding, holds) = match &law.damping {
                    AnyDamping::Constant(damping) => {
                        (format!("k = {}: V' = -k |r'|^2", number(damping.coefficient)), damping.coefficient > 0.0)
                    }
                    AnyDamping::Hyperbolic(damping) | AnyDamping::Saturated(SaturatedDamping(damping)) => (
                        format!(
                            "k(d) is 0 at the goal point alone and up to {}: V' = -k(d) |r'|^2 < 0 on every way there",
                            number(law.damping.coefficient(RANGE))
                        ),
                        damping.alpha > 0.0,
                    ),
                    AnyDamping::Written(_) | AnyDamping::Table(_) => {
                        let largest = law.damping.bounds(-RANGE, RANGE).map_or(f64::INFINITY, |bounds| bounds.high);
                        let largest = number(largest);
                        (format!("k(d) > 0 but at the goal point (proved), up to {largest}: V' = -k(d) |r'|^2"), true)
                    }
                };
                let damped = Verdict::new("damping", &name, holds, finding, "k > 0 (Theorem 5.3.1, A.10)");
                let able = bounds.map(|bounds| {
                    let largest =
                        Largest { trench: steepest(&law.trench, RANGE), zones: 0.0, obstacles: 0.0, at_once: [0, 0] };
                    of_scenario(&name, &largest, &bounds.limits)
                });
                let stopping = bounds.and_then(|bounds| stopping_of_goals(&name, &bounds, &task.robots));
                [potential(&name, &law.trench, RANGE), damped].into_iter().chain(able).chain(stopping)
            })
            .chain(feasibility(subject, scenario))
            .collect()
        }
        Task::Directed(task) => directed(subject, task),
        Task::Nearest(task, _) => nearest(subject, task, scenario.timing.duration),
        Task::Queue(task) => {
            let stopping = stopping_of_queue(subject, &task.queue);
            core::iter::once(queue(subject, task)).chain(feasibility(subject, scenario)).chain(stopping).collect()
        }
        Task::Launch(_) => Vec::new(),
    }
}

pub(crate) fn named(subject: &str, case: &str) -> String {
    if case.is_empty() { subject.to_owned() } else { format!("{subject}, case {case}") }
}

fn law(subject: &str, law: ChosenLaw) -> Vec<Verdict> {
    match law {
        ChosenLaw::Robust(gains_of) => vec![gains::gains(subject, "robust", gains_of)],
        ChosenLaw::Nominal(law) => {
            vec![gains::gains(subject, "nominal", Robust { k1: law.k1, k2: law.k2, k3: law.k1 })]
        }
        ChosenLaw::Direct(law) => vec![gains::gains(subject, "direct", Robust { k1: law.k1, k2: law.k2, k3: law.k1 })],
        ChosenLaw::Family(law) => {
            let Family { k1, k2, .. } = law;
            vec![gains::gains(subject, "family", Robust { k1, k2, k3: k1 }), gains::exponents(subject, &law)]
        }
    }
}

fn directed(subject: &str, task: &Directed) -> Vec<Verdict> {
    let chain = &task.chain;
    let radii = *chain.law.zoning.radii();
    let mut verdicts = vec![
        potential(subject, &chain.law.trench, RANGE),
        zones(subject, [radii.rho_underbar, radii.rho_hat, radii.rho, radii.rho_check, radii.rho_bar], 0.0),
        chain_damping(subject, &damped_directed(chain)),
    ];
    verdicts.extend(walls_of_directed(subject, chain));
    verdicts.extend(starts_of_directed(subject, chain));
    let robots = chain.robots.iter().zip(chain.directions.iter().copied());
    verdicts.extend(directions(subject, &Placed::new(&task.curve, Default::default()), robots, chain.law.damping));
    verdicts.extend(feasibility_of_directed(subject, task));
    let damping = chain.law.damping + chain.law.leader_damping;
    verdicts.extend(growth_at_rest(subject, "(6.1)", (&chain.law.trench, damping), &radii, chain.robots.len()));
    verdicts
}

fn nearest(subject: &str, task: &ChainScenario<AnyTrench>, duration: f64) -> Vec<Verdict> {
    let radii = *task.zoning.radii();
    let body = task.body_radius();
    let mut verdicts = vec![
        potential(subject, &task.law.trench, RANGE),
        zones(
            subject,
            [radii.rho_underbar, radii.rho_hat, radii.rho, radii.rho_check, radii.rho_bar],
            body.unwrap_or(0.0),
        ),
        chain_damping(subject, &damped_nearest(task)),
    ];
    verdicts.extend(task.options.limits.map(|limits| actuators(subject, task, &limits)));
    verdicts.extend(walls_of_nearest(subject, task));
    verdicts.extend(starts_of_nearest(subject, task));
    verdicts.extend(stopping_of_chain(subject, task));
    if !task.obstacles.is_empty() {
        verdicts.push(clearance(subject, task, body));
    }
    if let Some(Method::Directed { direction: Some(towards), .. }) = task.options.method {
        let frame = task.carriage.at(0.0).0;
        let robots = task.robots.iter().map(|robot| (robot, frame.rotation * towards));
        verdicts.extend(directions(subject, &Placed::new(&task.segment, frame), robots, task.law.damping));
    }
    verdicts.extend(feasibility_of_nearest(subject, task, duration));
    verdicts.push(transits(subject, &Placed::new(&task.segment, task.carriage.at(0.0).0), &task.robots));
    let damping = task.law.damping + task.law.leader_damping;
    verdicts.extend(growth_at_rest(subject, "(7.13)", (&task.law.trench, damping), &radii, task.robots.len()));
    verdicts
}

/// Whether each follower has a point of attraction in its direction.
fn directions<'a>(
    subject: &str,
    segment: &Placed<'_>,
    robots: impl Iterator<Item = (&'a PointState, Vector2<f64>)>,
    damping: f64,
) -> Vec<Verdict> {
    let of = |(index, (robot, towards)): (usize, (&PointState, Vector2<f64>))| {
        let approach = Approach { position: robot.position, velocity: robot.velocity, direction: towards, damping };
        direction(&format!("{subject}, r{}", index + 1), segment, &approach)
    };
    robots.enumerate().skip(1).map(of).collect()
}

/// What a team cannot do from where it begins: somebody is out of reach of its leader, the segment has too few places, places are too near to
/// each other, or its team goal is out of reach of all of it. Nothing else is looked at.
pub fn infeasible(subject: &str, scenario: &Scenario) -> Vec<Verdict> {
    let mut verdicts = feasibility(subject, scenario);
    verdicts.retain(|verdict| !verdict.holds);
    verdicts
}

fn feasibility(subject: &str, scenario: &Scenario) -> Vec<Verdict> {
    let duration = scenario.timing.duration;
    match &scenario.task {
        Task::Directed(task) => feasibility_of_directed(subject, task),
        Task::Nearest(task, _) => feasibility_of_nearest(subject, task, duration),
        Task::Queue(task) => {
            let separation = separation_of_queue(subject, &task.queue, scenario.tolerance);
            goal_of_queue(subject, task).into_iter().chain(separation).collect()
        }
        Task::GoalTracking(task) => separation_of_goals(subject, task, duration, scenario.tolerance),
        Task::Regulating(_) | Task::Launch(_) => Vec::new(),
    }
}

fn feasibility_of_directed(subject: &str, task: &Directed) -> Vec<Verdict> {
    let (radii, robots) = (task.chain.law.zoning.radii(), &task.chain.robots);
    let room = room(subject, &task.curve, &[task.curve.domain()], robots.len(), radii.rho_hat);
    let goal = goal(subject, &task.curve, task.chain.team_goal, radii, robots.len());
    [room, connection(subject, radii, robots, None)].into_iter().chain(goal).collect()
}

fn feasibility_of_nearest(subject: &str, task: &ChainScenario<AnyTrench>, duration: f64) -> Vec<Verdict> {
    let radii = task.zoning.radii();
    let room = fragments_at(task, 0.0)
        .map(|fragments| room(subject, &task.segment, fragments.intervals(), task.robots.len(), radii.rho_hat));
    let later = room_on_the_way(subject, task, duration);
    let goal = task.team_goal.and_then(|at| goal(subject, &task.segment, at, radii, task.robots.len()));
    let kept_off = goal_among_obstacles(subject, task, task.body_radius().unwrap_or(0.0), duration);
    let recovers = task.options.recovery.is_some().then_some(task);
    let connection = connection(subject, radii, &task.robots, recovers);
    room.into_iter().chain(later).chain([connection]).chain(goal).chain(kept_off).collect()
}

/// Whether the potential forces leave the stability argument whole when acceleration and speed are bounded.
fn actuators(subject: &str, task: &ChainScenario<AnyTrench>, limits: &Capability) -> Verdict {
    let obstacles = if task.obstacles.is_empty() { 0.0 } else { task.potential.full_acceleration() };
    // Along a direction the trench counts Phi'/sin alpha, as chapter 7 of docs/theory has it.
    let (trench, zones) = (steepest(&task.law.trench, RANGE) / least_sine(task), task.zoning.full_acceleration());
    let at_once = [task.robots.len().saturating_sub(1), task.obstacles.len()];
    of_scenario(subject, &Largest { trench, zones, obstacles, at_once }, limits)
}

/// Sine of the least angle between the direction of attraction and the segment.
pub(crate) fn least_sine(task: &ChainScenario<AnyTrench>) -> f64 {
    match task.options.method {
        Some(Method::Directed { direction: Some(along), .. }) => task.segment.least_sine(along),
        _ => 1.0,
    }
}
