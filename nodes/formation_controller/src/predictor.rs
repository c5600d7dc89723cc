//! Where the robot will be when the next command reaches its wheels.

use std::collections::VecDeque;
use trench_core::RosTime;
use trench_formation::kinematics::{Pose, Twist};

/// Commands kept: more than any delay between exposure and wheels spans at any camera rate.
const KEPT: usize = 32;

/// Remembers the commands that were sent and when they act, and drives a measured pose along them.
#[derive(Debug, Clone, Default)]
pub struct Predictor {
    sent: VecDeque<(RosTime, Twist)>,
}

impl Predictor {
    /// A command that acts from `acts` on.
    pub fn sent(&mut self, acts: RosTime, twist: Twist) {
        if self.sent.len() == KEPT {
            self.sent.pop_front();
        }
        self.sent.push_back((acts, twist));
    }

    /// The command in force at `time`: rest before the first one.
    #[must_use]
    pub fn in_force(&self, time: RosTime) -> Twist {
        self.sent.iter().rev().find(|(acts, _)| *acts <= time).map_or(Twist::ZERO, |(_, twist)| *twist)
    }

    /// The commands that begin to act between two times.
    pub(crate) fn between(&self, from: RosTime, until: RosTime) -> impl Iterator<Item = Twist> + '_ {
        self.sent.iter().filter(move |(acts, _)| *acts > from && *acts < until).map(|(_, twist)| *twist)
    }

    /// The pose at `until` of a robot that was at `pose` at `from` and followed its commands in between.
    #[must_use]
    pub fn predict(&self, mut pose: Pose, from: RosTime, until: RosTime) -> Pose {
        let mut time = from;
        let mut twist = self.in_force(from);
        for &(acts, next) in self.sent.iter().filter(|(acts, _)| *acts > from && *acts < until) {
            pose = pose.advanced(twist, acts.seconds_since(time));
            (time, twist) = (acts, next);
        }
        pose.advanced(twist, until.seconds_since(time).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(seconds: f64) -> RosTime {
        RosTime(0).plus_seconds(seconds)
    }

    #[test]
    fn drives_along_what_was_sent() {
        let mut predictor = Predictor::default();
        predictor.sent(at(1.0), Twist { v: 0.1, omega: 0.0 });
        predictor.sent(at(2.0), Twist { v: 0.3, omega: 0.0 });
        let check = |from, until, expected: f64| {
            let pose = predictor.predict(Pose::new(0.0, 0.0, 0.0), at(from), at(until));
            assert!((pose.x - expected).abs() < 1e-12, "{from} to {until}: {pose:?}");
        };
        check(0.0, 0.9, 0.0);
        check(0.0, 1.5, 0.05);
        check(1.5, 2.0, 0.05);
        check(1.5, 2.5, 0.2);
        check(3.0, 4.0, 0.3);
        check(3.0, 2.0, 0.0);
    }

    #[test]
    fn forgets_the_oldest() {
        let mut predictor = Predictor::default();
        for tick in 0..100 {
            predictor.sent(at(f64::from(tick)), Twist { v: f64::from(tick), omega: 0.0 });
        }
        assert_eq!(predictor.in_force(at(98.5)).v, 98.0);
        assert_eq!(predictor.in_force(at(10.0)), Twist::ZERO);
    }
}
