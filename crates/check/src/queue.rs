//! A formation against the robots that take it up.

use crate::approach::approaches;
use crate::growth::growth;
use crate::transits::of_segment;
use crate::verdict::number;
use crate::vertices::vertices;
use crate::{Team, Verdict};
use trench_formation::Vector2;
use trench_formation::assignment::robots_per_queue;
use trench_plan::{Frame, Plan, QueuePlan};

/// Points that a goal point passes, looked at on its way.
const SAMPLES: u32 = 256;
/// Segments turn away from each other by less than this (rad) if they are parallel.
const PARALLEL: f64 = 1e-3;

/// Judges a formation for a team: places, room between them, the field, speeds, chains.
pub fn formation(subject: &str, plan: &Plan, team: &Team) -> Vec<Verdict> {
    let mut verdicts = places(subject, plan, team);
    verdicts.push(separation(subject, plan, team));
    verdicts.extend(plan.queues.iter().filter_map(|queue| room(subject, queue, team)));
    if plan.frame == Frame::Map {
        verdicts.push(field(subject, plan, team));
    }
    verdicts.extend(motion(subject, plan, team));
    verdicts.extend(approaches(subject, plan, team));
    verdicts.extend(vertices(subject, plan, team));
    if ["nearest", "chain"].contains(&team.law.as_str()) {
        let of = |queue: &QueuePlan| of_segment(&format!("{subject}, queue {}", queue.name), &queue.curve);
        verdicts.extend(plan.queues.iter().filter_map(of));
    }
    verdicts.extend(plan.queues.iter().filter_map(|queue| growth(subject, plan, queue, team)));
    verdicts
}

/// Whether all robots have places, by the queues' shares.
fn places(subject: &str, plan: &Plan, team: &Team) -> Vec<Verdict> {
    let Some(robots) = team.robots else { return Vec::new() };
    let shares: Vec<f64> = plan.queues.iter().map(|queue| queue.share).collect();
    let verdict = |holds, finding: String| {
        Verdict::new("places", subject, holds, finding, "n_q = C_q n, by largest remainder (Definition 2.1.1)")
    };
    vec![match robots_per_queue(&shares, robots) {
        Err(wrong) => verdict(false, wrong.to_string()),
        Ok(counts) => {
            let full = counts.iter().zip(&plan.queues).find(|(count, queue)| **count > queue.places.len());
            match full {
                Some((count, queue)) => {
                    let (name, has) = (&queue.name, queue.places.len());
                    let finding = format!(
                        "queue {name} gets {count} of {robots} robots, but has {has} places: give it more vertices or a \
                         smaller share"
                    );
                    verdict(false, finding)
                }
                None => {
                    let each = counts
                        .iter()
                        .zip(&plan.queues)
                        .map(|(count, queue)| format!("{} {count} of {}", queue.name, queue.places.len()));
                    verdict(true, format!("{robots} robots fill {}", each.collect::<Vec<_>>().join(", ")))
                }
            }
        }
    }]
}

/// Whether robots at their starts, and at their places, stand apart.
fn separation(subject: &str, plan: &Plan, team: &Team) -> Verdict {
    let needed = 2.0 * (team.radius + team.margin);
    let named = |ends: bool| {
        let queues = plan.queues.iter();
        queues.flat_map(move |queue| {
            queue.places.iter().map(move |place| {
                let at = queue.curve.at(if ends { place.end } else { place.start }).point;
                (queue.name.as_str(), at)
            })
        })
    };
    let mut nearest: Option<(f64, String)> = None;
    for (what, points) in [("places", named(true).collect::<Vec<_>>()), ("starts", named(false).collect())] {
        for (index, (name, point)) in points.iter().enumerate() {
            for (other_name, other) in &points[..index] {
                let distance = (point - other).norm();
                if nearest.as_ref().is_none_or(|(least, _)| distance < *least) {
                    let between = if name == other_name {
                        format!("two {what} of {name}")
                    } else {
                        format!("{what} of {other_name} and {name}")
                    };
                    nearest = Some((distance, between));
                }
            }
        }
    }
    let verdict = |holds, finding: String| {
        Verdict::new("separation", subject, holds, finding, "|x_i - x_j| >= 2 (R + margin) of any two places")
    };
    match nearest {
        None => verdict(true, "one place only".to_owned()),
        Some((distance, between)) => {
            let (distance_text, needed_text) = (number(distance), number(needed));
            let finding = format!("{between} are {distance_text} m apart");
            if distance >= needed {
                verdict(true, format!("{finding}, at least {needed_text} m are needed"))
            } else {
                verdict(false, format!("{finding}, but {needed_text} m are needed: move them apart"))
            }
        }
    }
}

/// Whether the segment is long enough for the chain on it, and its spacing neutral.
fn room(subject: &str, queue: &QueuePlan, team: &Team) -> Option<Verdict> {
    let robots = queue.places.len();
    let subject = format!("{subject}, queue {}", queue.name);
    let [rho_underbar, rho_hat, rho, rho_check, _] = team.zones?;
    let (from, to) = queue.curve.domain();
    let (needed, length) = (rho_hat * robots.saturating_sub(1) as f64, to - from);
    let verdict = |holds, finding| {
        Some(Verdict::new(
            "room",
            &subject,
            holds,
            finding,
            "(n - 1) rho_hat <= length; from zones 2 to 4 followers settle in zone 3 (6.4)",
        ))
    };
    if needed > length {
        let most = libm::floor(length / rho_hat) + 1.0;
        let (length, needed) = (number(length), number(needed));
        let finding =
            format!("{robots} robots need {needed} m of segment, but it is {length} m long: at most {most} robots fit");
        return verdict(false, finding);
    }
    let length = if length.is_finite() { format!("{} m long", number(length)) } else { "open".to_owned() };
    let finding = format!("{robots} robots need {} m of segment, which is {length}", number(needed));
    match queue.chain.filter(|chain| chain.robots > 1) {
        Some(chain) => {
            let (spacing, low, high) = (number(chain.spacing), number(rho_hat), number(rho));
            if !(chain.spacing > rho_underbar && chain.spacing < rho_check) {
                return verdict(
                    false,
                    format!("places are {spacing} m apart, outside zones 2 to 4: take {low} to {high} m"),
                );
            }
            let settled = if (rho_hat..=rho).contains(&chain.spacing) {
                "are neutral".to_owned()
            } else {
                format!("will be left for the neutral zone, {low} to {high} m")
            };
            verdict(true, format!("{finding}; places {spacing} m apart {settled}"))
        }
        None => verdict(true, finding),
    }
}

/// Whether robots on their goal points' ways stay inside the field.
fn field(subject: &str, plan: &Plan, team: &Team) -> Verdict {
    let needed = team.radius + team.margin;
    let mut least = (f64::INFINITY, "", Vector2::zeros());
    for queue in &plan.queues {
        for place in &queue.places {
            for index in 0..=SAMPLES {
                let share = f64::from(index) / f64::from(SAMPLES);
                let point = queue.curve.at(place.start + share * (place.end - place.start)).point;
                let [[low_x, high_x], [low_y, high_y]] = team.field;
                let gap = (point.x - low_x).min(high_x - point.x).min(point.y - low_y).min(high_y - point.y);
                if gap < least.0 {
                    least = (gap, &queue.name, point);
                }
            }
        }
    }
    let (gap, name, point) = least;
    let finding = format!(
        "the way of queue {name} comes to {} m from the edge of the field, at [{}, {}]",
        number(gap),
        number(point.x),
        number(point.y)
    );
    let holds = gap >= needed;
    let needed = number(needed);
    let finding = if holds {
        format!("{finding}; {needed} m are needed")
    } else {
        format!("{finding}, but {needed} m are needed: move it inward")
    };
    Verdict::new("field", subject, holds, finding, "distance to the edge >= R + margin along the way")
}

/// Whether robots keep up with moving goal points, and keep the shape meanwhile.
fn motion(subject: &str, plan: &Plan, team: &Team) -> Vec<Verdict> {
    let speed = plan.motion.speed;
    let moves = plan.queues.iter().flat_map(|queue| &queue.places).any(|place| place.start != place.end);
    if speed <= 0.0 || !moves {
        return Vec::new();
    }
    let text = format!("goal points move at {} m/s, wheels at up to {} m/s", number(speed), number(team.wheel_speed));
    let holds = speed < team.wheel_speed;
    let finding = if holds { text } else { format!("{text}: slow the points down (motion.speed)") };
    let mut verdicts = vec![Verdict::new("speed", subject, holds, finding, "v < wheels.max_speed")];
    if !team.feeds_forward {
        let lag = number(speed / team.approach_gain);
        let parallel = are_parallel(plan);
        let finding = if parallel {
            format!("robots lag {lag} m behind their moving points, all in the same direction: the shape is kept")
        } else {
            format!(
                "robots lag {lag} m behind their moving points, in directions that differ: the shape is lost while they move; \
                 set feed_forward to true"
            )
        };
        verdicts.push(Verdict::new("lag", subject, parallel, finding, "v / K1, the same for parallel segments (4.6)"));
    }
    verdicts
}

/// Whether all goal points that move go the same way.
fn are_parallel(plan: &Plan) -> bool {
    let mut tangents = plan.queues.iter().flat_map(|queue| {
        queue.places.iter().filter(|place| place.start != place.end).flat_map(|place| {
            let forward = if place.end >= place.start { 1.0 } else { -1.0 };
            [place.start, place.end].map(|at| forward * queue.curve.at(at).tangent)
        })
    });
    let Some(first) = tangents.next() else { return true };
    tangents.all(|tangent| first.perp(&tangent).abs() < PARALLEL && first.dot(&tangent) > 0.0)
}
