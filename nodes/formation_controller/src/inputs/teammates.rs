//! What the other robots say of themselves.

use super::{Heard, INTERVAL, Inputs, stamps::timely, vector};
use crate::refusal::Refusal;
use nalgebra::Isometry2;
use std::collections::BTreeMap;
use trench_core::{RosTime, Steady, Times};
use trench_formation::Vector2;
use trench_formation::agent::Leader;
use trench_formation::kinematics::PointState;
use trench_msgs::msg::{Assignment, LeaderStateView, Member, Point2};

/// The newest states of the others.
#[derive(Debug, Clone, Default)]
pub(crate) struct Others {
    /// Whatever they follow.
    said: BTreeMap<String, Heard<Spoken>>,
    /// The newest that counted when it came: of our assignment then.
    teammates: BTreeMap<String, Heard<Spoken>>,
}

/// What a controller goes by of a leader state.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Spoken {
    stamp: RosTime,
    epoch: u64,
    formation_hash: u64,
    point: Point2,
    point_velocity: Point2,
    place: Point2,
    pub(crate) goal_distance: f64,
    lyapunov: f64,
    error_bound: f64,
    pub(crate) limited_by: u8,
}

impl From<&LeaderStateView<'_>> for Spoken {
    fn from(state: &LeaderStateView<'_>) -> Self {
        Self {
            stamp: RosTime::from(&state.header.stamp),
            epoch: state.epoch,
            formation_hash: state.formation_hash,
            point: state.point,
            point_velocity: state.point_velocity,
            place: state.place,
            goal_distance: state.goal_distance,
            lyapunov: state.lyapunov,
            error_bound: state.error_bound,
            limited_by: state.limited_by,
        }
    }
}

/// A robot ahead in the chain at a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ahead {
    /// The point that it steers, and its distance from what draws it.
    pub(crate) leader: Leader,
    /// Its Lyapunov function, m^2/s^2.
    pub(crate) lyapunov: f64,
    /// The place that it has chosen, m, frame of the formation; none where it speaks of another formation.
    place: Option<Vector2<f64>>,
    /// M of (8.26); infinite where nothing bounds its error.
    pub(crate) error_bound: f64,
}

impl Ahead {
    /// The place that it has chosen, or where it is, m, map.
    pub(crate) fn place_in(&self, map_from_segment: Isometry2<f64>) -> Vector2<f64> {
        self.place.map_or(self.leader.state.position, |place| map_from_segment.transform_point(&place.into()).coords)
    }
}

impl Inputs {
    /// Takes what another robot says of itself; as a teammate it counts only under the same assignment and formation.
    ///
    /// # Errors
    /// Why it does not count.
    pub(crate) fn take_other(&mut self, at: Times, name: &str, message: Spoken) -> Result<(), Refusal> {
        let points = [&message.point, &message.point_velocity, &message.place];
        let sum: f64 = points.iter().map(|point| point.x + point.y).sum();
        // A bound may be infinite.
        if !(sum + message.goal_distance + message.lyapunov).is_finite() || message.error_bound.is_nan() {
            return Err(Refusal::NotFinite);
        }
        timely(at, message.stamp, self.others.said.get(name).map(|before| before.message.stamp))?;
        let judged = self.assignment.as_ref().map_or(Ok(()), |ours| same(ours, &message));
        // A robot that has not heard of any assignment yet is no teammate, and nothing is wrong with what it says.
        let unassigned = message.epoch == 0;
        let heard = Heard { at: at.steady, message };
        if judged.is_ok() {
            keep(&mut self.others.teammates, name, heard);
        }
        keep(&mut self.others.said, name, heard);
        if unassigned { Ok(()) } else { judged }
    }

    /// Whether one of the other robots of the queue of `member` is heard; a robot that has none is not missing any.
    pub(crate) fn hears_of_queue(&self, member: &Member, now: Steady, age_limit: f64) -> bool {
        let mut mates = self.mates(member).peekable();
        mates.peek().is_none() || mates.any(|mate| self.others.said(&mate.robot, now, age_limit).is_some())
    }

    /// A robot ahead at `time`: what it said last, going on as it moved; none once that was received, or made, more than `age_limit`
    /// seconds ago.
    ///
    /// Right after a new assignment nobody has spoken of it yet: where a robot is still holds then, how far it is from what draws it
    /// does not.
    pub(crate) fn teammate(&self, name: &str, (at, time): (Times, RosTime), age_limit: f64) -> Option<Ahead> {
        let ours = self.assignment.as_ref();
        let of_ours = |heard: &&Heard<Spoken>| ours.is_none_or(|ours| same(ours, &heard.message).is_ok());
        let newest = self.others.said.get(name).filter(of_ours);
        let heard = newest.or_else(|| self.others.teammates.get(name))?;
        let said = &heard.message;
        if at.steady.seconds_since(heard.at).max(at.ros.seconds_since(said.stamp)) > age_limit {
            return None;
        }
        let elapsed = time.seconds_since(said.stamp).clamp(0.0, age_limit + INTERVAL);
        let velocity = vector(&said.point_velocity);
        let state = PointState { position: vector(&said.point) + elapsed * velocity, velocity };
        let ours = of_ours(&heard);
        let or_infinite = |number: f64| if ours { number } else { f64::INFINITY };
        let leader = Leader { state, deviation: or_infinite(said.goal_distance) };
        let place = ours.then(|| vector(&said.place));
        Some(Ahead { leader, lyapunov: said.lyapunov, place, error_bound: or_infinite(said.error_bound) })
    }
}

impl Others {
    /// The robots whose leader states arrived within `age_limit` seconds, in order of name.
    pub(crate) fn heard(&self, now: Steady, age_limit: f64) -> impl Iterator<Item = &str> {
        let fresh = move |heard: &Heard<Spoken>| now.seconds_since(heard.at) <= age_limit;
        self.said.iter().filter(move |(_, heard)| fresh(heard)).map(|(name, _)| name.as_str())
    }

    /// What `name` says of itself, if it was received within `age_limit` seconds.
    pub(crate) fn said(&self, name: &str, now: Steady, age_limit: f64) -> Option<&Spoken> {
        let heard = self.said.get(name).filter(|heard| now.seconds_since(heard.at) <= age_limit)?;
        Some(&heard.message)
    }
}

/// Each tick brings the same names again.
fn keep(states: &mut BTreeMap<String, Heard<Spoken>>, name: &str, heard: Heard<Spoken>) {
    match states.get_mut(name) {
        Some(before) => *before = heard,
        None => drop(states.insert(name.to_owned(), heard)),
    }
}

fn same(ours: &Assignment, message: &Spoken) -> Result<(), Refusal> {
    if message.epoch != ours.epoch {
        return Err(Refusal::Epoch { theirs: message.epoch, ours: ours.epoch });
    }
    if message.formation_hash != ours.formation_hash {
        return Err(Refusal::Formation);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(seconds: f64) -> Times {
        Times { ros: RosTime(0).plus_seconds(seconds), steady: Steady(0).plus_seconds(seconds) }
    }

    fn state(stamp: f64, epoch: u64) -> Spoken {
        Spoken {
            stamp: RosTime(0).plus_seconds(stamp),
            epoch,
            goal_distance: 0.25,
            point_velocity: Point2 { x: 0.5, y: 0.0 },
            place: Point2 { x: 2.0, y: 0.0 },
            ..Spoken::default()
        }
    }

    fn inputs(epoch: u64) -> Inputs {
        Inputs { assignment: Some(Assignment { epoch, ..Default::default() }), ..Default::default() }
    }

    fn ahead(inputs: &Inputs, seconds: f64) -> Option<Leader> {
        inputs.teammate("r", (at(seconds), at(seconds).ros), 0.4).map(|ahead| ahead.leader)
    }

    fn place(inputs: &Inputs, seconds: f64) -> Vector2<f64> {
        let ahead = inputs.teammate("r", (at(seconds), at(seconds).ros), 0.4).unwrap();
        ahead.place_in(Isometry2::translation(0.0, 3.0))
    }

    #[test]
    fn it_goes_on_for_a_bounded_time() {
        let mut inputs = inputs(4);
        inputs.take_other(at(1.0), "r", state(1.0, 4)).unwrap();
        assert_eq!(ahead(&inputs, 1.2).unwrap().state.position.x, 0.1);
        assert_eq!(ahead(&inputs, 1.2).unwrap().deviation, 0.25);
        assert_eq!(place(&inputs, 1.2), Vector2::new(2.0, 3.0), "carried by the formation's frame");
        assert!(ahead(&inputs, 1.5).is_none());
    }

    /// What was made long ago is old, however late it came.
    #[test]
    fn what_waited_on_its_way_is_old() {
        let mut inputs = inputs(4);
        inputs.take_other(at(2.0), "r", state(1.0, 4)).unwrap();
        assert!(ahead(&inputs, 2.0).is_none());
    }

    #[test]
    fn a_new_assignment_forgets_how_far_anybody_has_come() {
        let mut inputs = inputs(4);
        inputs.take_other(at(1.0), "r", state(1.0, 4)).unwrap();
        inputs.assignment = Some(Assignment { epoch: 5, ..Default::default() });
        assert_eq!(ahead(&inputs, 1.0).unwrap().deviation, f64::INFINITY);
        assert_eq!(place(&inputs, 1.0).x, 0.0, "where it is");
        // Who still follows the old one no longer counts.
        assert!(inputs.take_other(at(1.1), "r", state(1.1, 4)).is_err());
        assert!(ahead(&inputs, 1.45).is_none());
    }

    /// At the start some hear of the assignment later than others.
    #[test]
    fn who_has_no_assignment_yet_is_heard_and_is_no_teammate() {
        let mut inputs = inputs(4);
        inputs.take_other(at(1.0), "r", state(1.0, 0)).unwrap();
        assert!(ahead(&inputs, 1.0).is_none());
        assert_eq!(inputs.others.heard(at(1.0).steady, 0.4).collect::<Vec<_>>(), ["r"]);
    }

    /// The leader heard of the new assignment before we did.
    #[test]
    fn what_came_early_counts_in_time() {
        let mut inputs = inputs(4);
        assert_eq!(inputs.take_other(at(1.0), "r", state(1.0, 5)), Err(Refusal::Epoch { theirs: 5, ours: 4 }));
        assert!(ahead(&inputs, 1.0).is_none());
        inputs.assignment = Some(Assignment { epoch: 5, ..Default::default() });
        assert_eq!(ahead(&inputs, 1.0).unwrap().deviation, 0.25);
    }
}
