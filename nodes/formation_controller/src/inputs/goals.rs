//! What leader_assignment says of the formation's frame and of goal points.

use super::{Heard, Inputs, stamps::timely, vector};
use crate::refusal::Refusal;
use nalgebra::{Isometry2, UnitComplex};
use trench_core::{RosTime, Times};
use trench_formation::laws::{GoalMotion, RigidMotion};
use trench_msgs::msg::{Goal, Goals};

/// The newest goals.
#[derive(Debug, Clone, Default)]
pub(crate) struct Said(Option<Heard<Goals>>);

impl Inputs {
    /// Takes goals, unless they are of an assignment that was replaced, late, or from the future.
    ///
    /// # Errors
    /// Why they are refused.
    pub(crate) fn take_goals(&mut self, at: Times, message: Goals) -> Result<(), Refusal> {
        let ours = self.assignment.as_ref().map_or(0, |assignment| assignment.epoch);
        if message.epoch < ours && message.epoch != 0 && !self.orders.has(message.epoch) {
            return Err(Refusal::Epoch { theirs: message.epoch, ours });
        }
        timely(at, RosTime::from(&message.header.stamp), self.goals.stamp())?;
        if !message.is_finite() {
            return Err(Refusal::NotFinite);
        }
        let is_new = message.epoch != self.goals.epoch();
        self.goals = Said(Some(Heard { at: at.steady, message }));
        if is_new {
            self.choose_again();
        }
        Ok(())
    }
}

impl Said {
    /// Of the assignment that they are of, 0 where none were heard.
    pub(super) fn epoch(&self) -> u64 {
        self.0.as_ref().map_or(0, |heard| heard.message.epoch)
    }

    pub(super) fn stamp(&self) -> Option<RosTime> {
        Some(RosTime::from(&self.0.as_ref()?.message.header.stamp))
    }

    /// Whether they were neither received nor made more than `age_limit` seconds ago: what is older drives nobody.
    pub(crate) fn are_young(&self, at: Times, age_limit: f64) -> bool {
        self.0.as_ref().is_some_and(|heard| {
            let made = RosTime::from(&heard.message.header.stamp);
            at.steady.seconds_since(heard.at) <= age_limit && at.ros.seconds_since(made) <= age_limit
        })
    }

    /// Pose and motion of the formation's frame at `time`, however old: whoever drives by it asks whether the goals are young.
    pub(crate) fn frame(&self, time: RosTime) -> Option<(Isometry2<f64>, RigidMotion)> {
        let message = &self.0.as_ref()?.message;
        let frame = &message.frame;
        let origin = GoalMotion {
            position: vector(&frame.position),
            velocity: vector(&frame.velocity),
            acceleration: vector(&frame.acceleration),
        };
        let (sine, cosine) = libm::sincos(frame.theta);
        let rotation = UnitComplex::from_cos_sin_unchecked(cosine, sine);
        let motion = RigidMotion { origin, turn_rate: frame.turn_rate, turn_acceleration: 0.0 };
        let elapsed = time.seconds_since(RosTime::from(&message.header.stamp)).clamp(-1.0, 1.0);
        Some(motion.carried(Isometry2::from_parts(origin.position.into(), rotation), elapsed))
    }

    /// The goal of `robot` at `time` and its phase, however old.
    pub(crate) fn of(&self, robot: &str, time: RosTime) -> Option<(GoalMotion, u8)> {
        let message = &self.0.as_ref()?.message;
        let goal = message.goals.iter().find(|goal| goal.robot == robot)?;
        Some((extrapolate(goal, time.seconds_since(RosTime::from(&message.header.stamp))), goal.phase))
    }
}

/// The goal point `ahead` seconds after its stamp: it moves for `remaining` seconds and rests then.
fn extrapolate(goal: &Goal, ahead: f64) -> GoalMotion {
    let motion = GoalMotion {
        position: vector(&goal.position),
        velocity: vector(&goal.velocity),
        acceleration: vector(&goal.acceleration),
    };
    let remaining = goal.remaining.max(0.0);
    let moved = motion.after(ahead.min(remaining));
    if ahead < remaining { moved } else { GoalMotion::at_rest(moved.position) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_core::Steady;
    use trench_msgs::msg::Point2;

    #[test]
    fn goals_move_as_long_as_they_are_said_to() {
        let goal = Goal {
            position: Point2 { x: 1.0, y: 0.0 },
            velocity: Point2 { x: 0.1, y: 0.0 },
            remaining: 2.0,
            ..Default::default()
        };
        let check = |ahead, x: f64, speed: f64| {
            let motion = extrapolate(&goal, ahead);
            assert!((motion.position.x - x).abs() < 1e-12 && (motion.velocity.x - speed).abs() < 1e-12, "{motion:?}");
        };
        check(0.0, 1.0, 0.1);
        check(1.0, 1.1, 0.1);
        check(3.0, 1.2, 0.0);
    }

    #[test]
    fn old_goals_are_no_goals() {
        let at =
            |ros: f64, steady: f64| Times { ros: RosTime(0).plus_seconds(ros), steady: Steady(0).plus_seconds(steady) };
        let goals = Goals { goals: vec![Goal { robot: "r".to_owned(), ..Default::default() }], ..Default::default() };
        let mut inputs = Inputs::default();
        inputs.take_goals(at(0.1, 0.0), goals).unwrap();
        let are_young = |ros, steady| inputs.goals.are_young(at(ros, steady), 0.5);
        assert!(are_young(0.4, 0.4));
        assert!(!are_young(0.4, 0.6), "received too long ago");
        assert!(!are_young(0.6, 0.1), "made too long ago");
        assert!(!Said::default().are_young(at(0.0, 0.0), 0.5), "never heard");
        let goal = |robot: &str| inputs.goals.of(robot, RosTime(0)).is_some();
        assert!(goal("r") && !goal("s"));
    }
}
