//! Whether the followers of a formation have points of attraction under law (6.1).

use crate::direction::{Across, EQUATION};
use crate::team::{Along, Start};
use crate::verdict::number;
use crate::{Approach, Team, Verdict, direction};
use nalgebra::Isometry2;
use trench_formation::Vector2;
use trench_formation::curve::{Curve, Placed};
use trench_plan::{Frame, Plan, QueuePlan};

/// Tangents looked at for places where a segment turns away along the direction.
const SAMPLES: u32 = 2048;

/// Judges the directions of attraction of each queue: of the followers at their starts where those are known, else of whoever begins
/// where the segment lets it.
pub(crate) fn approaches(subject: &str, plan: &Plan, team: &Team) -> Vec<Verdict> {
    let Some(along) = &team.along else { return Vec::new() };
    let of = |(index, queue): (usize, &QueuePlan)| {
        let subject = format!("{subject}, queue {}", queue.name);
        let is_follower = |start: &&Start| start.queue == index && start.rank > 1;
        let followers: Vec<&Start> = team.starts.iter().filter(is_follower).collect();
        match (plan.frame, team.starts.is_empty()) {
            (Frame::Map, false) if followers.is_empty() => Vec::new(),
            (Frame::Map, false) => of_followers(&subject, &queue.curve, along, &followers),
            _ => vec![of_anyone(&subject, queue, along)],
        }
    };
    plan.queues.iter().enumerate().filter(|(_, queue)| queue.places.len() > 1).flat_map(of).collect()
}

/// One verdict if all directions are proper, else one for each that is not.
fn of_followers(subject: &str, curve: &Curve, along: &Along, followers: &[&Start]) -> Vec<Verdict> {
    let placed = Placed::new(curve, Isometry2::identity());
    let (mut failed, mut nearest) = (Vec::new(), (f64::INFINITY, ""));
    for start in followers {
        let approach = Approach {
            position: start.position,
            velocity: Vector2::zeros(),
            direction: along.direction.unwrap_or_else(|| across_at(curve, start.position)),
            damping: along.damping,
        };
        let named = format!("{subject}, {}", start.robot);
        let verdict = direction(&named, &placed, &approach);
        let spare = Across::of(&placed, &approach).map_or(f64::NEG_INFINITY, |across| across.spare());
        if !verdict.holds {
            failed.push(match along.direction {
                Some(_) => verdict,
                None => beyond_the_end(&named, -spare),
            });
        } else if let Some(at) = fold_near(curve, along, start.position) {
            let finding = format!(
                "the segment turns away along the direction at {} m, where the robot comes by: its point of attraction would jump; turn \
                 the direction, or leave it out (across the segment)",
                number(at)
            );
            failed.push(Verdict::new("direction", &named, false, finding, EQUATION));
        }
        if spare < nearest.0 {
            nearest = (spare, &start.robot);
        }
    }
    if !failed.is_empty() {
        return failed;
    }
    let (spare, robot) = nearest;
    // What a robot may drift that is given the segment while it moves.
    let drift = along.speed / along.damping;
    let moving = if spare >= drift {
        format!("enough for the {} m that a robot drifts from {} m/s", number(drift), number(along.speed))
    } else {
        format!(
            "too little for a robot that is given the segment at {} m/s: it drifts {} m",
            number(along.speed),
            number(drift)
        )
    };
    let finding = format!(
        "all {} followers begin, at rest, where their directions meet the segment; {robot} is nearest to missing it, by {} m: {moving}",
        followers.len(),
        number(spare)
    );
    vec![match spare >= drift {
        true => Verdict::new("direction", subject, true, finding, EQUATION),
        false => Verdict::noted("direction", subject, finding, EQUATION),
    }]
}

/// Without a direction the nearest point draws: it is an end until the robot is beside the segment.
fn beyond_the_end(subject: &str, missing: f64) -> Verdict {
    let finding = format!(
        "begins {} m beyond the end of the segment: nothing lies across from it, and its nearest point, the end, draws it until it is beside",
        number(missing)
    );
    Verdict::noted("direction", subject, finding, EQUATION)
}

/// Where robots may begin, if nobody knows where they do.
fn of_anyone(subject: &str, queue: &QueuePlan, along: &Along) -> Verdict {
    let curve = &queue.curve;
    let placed = Placed::new(curve, Isometry2::identity());
    let drift = along.speed / along.damping;
    let verdict = |holds, finding: String| Verdict::new("direction", subject, holds, finding, EQUATION);
    let (direction, which) = match along.direction {
        Some(direction) => (direction, format!("along [{}, {}]", number(direction.x), number(direction.y))),
        None => {
            let middle = curve.at(0.5 * curve.length());
            (normal(middle.tangent), "across the segment".to_owned())
        }
    };
    let approach =
        Approach { position: Vector2::zeros(), velocity: Vector2::zeros(), direction, damping: along.damping };
    let Some(across) = Across::of(&placed, &approach) else {
        return verdict(false, "the damping is not positive: give one".to_owned());
    };
    let (low, high) = across.segment;
    let drifting = format!("a robot drifts up to {} m from {} m/s", number(drift), number(along.speed));
    if high - low < 2.0 * drift {
        let finding = format!(
            "{which} the segment spans {} m, but {drifting} to either side: turn the direction, or make the segment {} m longer there",
            number(high - low),
            number(2.0 * drift - (high - low))
        );
        return verdict(false, finding);
    }
    let room = format!("{} m of the {} m that the segment spans", number(high - low - 2.0 * drift), number(high - low));
    let finding = format!("{which}, {drifting}: directions are proper for robots that begin beside the inner {room}");
    match fold(curve, along.direction, |_| true) {
        Some(at) => Verdict::noted(
            "direction",
            subject,
            format!("{finding}, and not beside where the segment turns away along the direction, at {} m", number(at)),
            EQUATION,
        ),
        None => verdict(true, finding),
    }
}

fn normal(tangent: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-tangent.y, tangent.x)
}

/// Across the segment where it is nearest to a robot.
fn across_at(curve: &Curve, robot: Vector2<f64>) -> Vector2<f64> {
    normal(curve.nearest(robot).tangent)
}

/// A fold that a robot's direction meets, by arc length, m.
fn fold_near(curve: &Curve, along: &Along, robot: Vector2<f64>) -> Option<f64> {
    let direction = along.direction?.normalize();
    let drift = along.speed / along.damping;
    fold(curve, along.direction, |point| direction.perp(&(point - robot)).abs() <= drift)
}

/// The first place that counts at which the segment, seen along the direction, turns back: there the point of attraction ceases to be.
fn fold(curve: &Curve, direction: Option<Vector2<f64>>, counts: impl Fn(Vector2<f64>) -> bool) -> Option<f64> {
    let direction = direction?;
    let length = curve.length();
    let feet = (0..=SAMPLES).map(|index| curve.at(length * f64::from(index) / f64::from(SAMPLES)));
    let mut last = 0.0_f64;
    for foot in feet {
        let crossing = direction.perp(&foot.tangent);
        if crossing * last < 0.0 && counts(foot.point) {
            return Some(foot.arc_length);
        }
        if crossing != 0.0 {
            last = crossing;
        }
    }
    None
}
