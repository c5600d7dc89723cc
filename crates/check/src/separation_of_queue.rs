//! Whether a queue's robots have room in their places, and where those go that quit it (A.22).

use crate::Verdict;
use crate::separation::{Nearest, Needed, separation};
use crate::verdict::number;
use trench_formation::Vector2;
use trench_formation::simulate::{QueueRobotScenario, QueueScenario};

/// Where a robot stands for a time.
#[derive(Debug, Clone, PartialEq)]
struct Stand {
    /// For people.
    what: String,
    /// Number of the place, from 0 on; none: a point beside the queue.
    place: Option<usize>,
    /// m.
    at: Vector2<f64>,
    /// From when to when it may be taken, s.
    taken: [f64; 2],
}

impl Stand {
    /// Whether somebody may be at each of both at once.
    fn meets(&self, other: &Self) -> bool {
        self.taken[0] < other.taken[1] && other.taken[0] < self.taken[1]
    }
}

/// Of places, points where robots wait until they join, and points to which they quit; nothing where there is one alone.
pub(crate) fn separation_of_queue(subject: &str, queue: &QueueScenario, tolerance: f64) -> Option<Verdict> {
    let stands = stands(queue);
    let pairs =
        stands.iter().enumerate().flat_map(|(index, one)| stands[..index].iter().map(move |other| (other, one)));
    let together =
        pairs.filter(|(one, other)| one.meets(other)).map(|(one, other)| ((one.at - other.at).norm(), one, other));
    let (distance, one, other) = together.min_by(|one, other| one.0.total_cmp(&other.0))?;
    let finding = format!("{} and {} are {} m apart", one.what, other.what, number(distance));
    let needed = Needed::of(queue.safety.map(|safety| safety.radius), tolerance);
    let remedy = match (one.place, other.place) {
        // Straight on is the longest way that there is between neighbours.
        (Some(_), Some(_)) if !needed.is_met_by(queue.spacing) => {
            format!("make spacing {}", needed.or_more())
        }
        (Some(one), Some(other)) => format!(
            "the segment comes back to itself there, {} m farther along it; keep its parts farther from each other, or choose another spacing",
            number((other - one) as f64 * queue.spacing)
        ),
        _ => "write another point".to_owned(),
    };
    Some(separation(subject, needed, Nearest { distance, finding, remedy }))
}

/// All that there are in the run.
fn stands(queue: &QueueScenario) -> Vec<Stand> {
    let place = |(slot, taken): (usize, [f64; 2])| Stand {
        what: format!("place {}", slot + 1),
        place: Some(slot),
        at: queue.segment.at(queue.first_place() - slot as f64 * queue.spacing).point,
        taken,
    };
    let places = places(queue).into_iter().enumerate().map(place);
    let beside = queue.robots.iter().enumerate().flat_map(|(index, robot)| {
        let name = format!("r{}", index + 1);
        let waits = robot.joins.map(|joins| Stand {
            what: format!("the point where {name} waits until it joins"),
            place: None,
            at: robot.start.position,
            taken: [0.0, joins],
        });
        let quits = robot.quits.map(|quits| Stand {
            what: format!("the point to which {name} quits"),
            place: None,
            at: quits.to,
            taken: [quits.at, f64::INFINITY],
        });
        waits.into_iter().chain(quits)
    });
    places.chain(beside).collect()
}

/// From when to when (s) each place may be taken: the last one is new when somebody joins, and free for good when somebody quits and the
/// others close up. A place that is left empty counts as taken, since somebody may come to it.
fn places(queue: &QueueScenario) -> Vec<[f64; 2]> {
    if queue.recovery.is_some() {
        // Who is lost comes back at any time.
        return vec![[0.0, f64::INFINITY]; queue.robots.len()];
    }
    let change = |robot: &QueueRobotScenario| {
        let joins = robot.joins.map(|at| (at, true));
        let quits = robot.quits.filter(|quits| quits.closes_up).map(|quits| (quits.at, false));
        joins.into_iter().chain(quits)
    };
    let mut changes: Vec<(f64, bool)> = queue.robots.iter().flat_map(change).collect();
    // Of those at one time joining is first: more places rather than fewer.
    changes.sort_by(|one, other| one.0.total_cmp(&other.0).then(other.1.cmp(&one.1)));
    let mut count = queue.robots.iter().filter(|robot| robot.joins.is_none()).count();
    let mut taken = vec![[0.0, f64::INFINITY]; count];
    for (at, joins) in changes {
        if !joins {
            count = count.saturating_sub(1);
            if let Some(last) = taken.get_mut(count) {
                last[1] = at;
            }
            continue;
        }
        match taken.get_mut(count) {
            Some(again) => again[1] = f64::INFINITY,
            None => taken.push([at, f64::INFINITY]),
        }
        count += 1;
    }
    taken
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = include_str!("../../../config/scenarios/A.22_quit_and_join.yaml");

    fn of(text: &str) -> QueueScenario {
        match trench_scenario::parse("queue", text).unwrap().task {
            trench_scenario::Task::Queue(task) => task.queue,
            other => panic!("{other:?}"),
        }
    }

    /// Six robots; r3 quits at 15 s and r7 comes at 30 s, r2 leaves its place empty at 45 s and r8 comes at 60 s.
    #[test]
    fn places_are_taken_while_somebody_may_be_there() {
        let always = [0.0, f64::INFINITY];
        let mut expected = vec![always; 6];
        expected.push([60.0, f64::INFINITY]);
        assert_eq!(places(&of(FILE)), expected);
        let last = of(&FILE.replace("joins: 30.0", "joins: 10.0, quits: {at: 20.0, to: [0.0, 9.0]}"));
        expected.truncate(5);
        expected.extend([[0.0, f64::INFINITY], [10.0, 15.0]]);
        assert_eq!(places(&last), expected);
    }
}
