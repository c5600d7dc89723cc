//! Whether the robot moves as its wheels are told, to within tenths of a millimetre: slipping or stuck wheels, hands, obstacles.
//!
//! Coarser and slower deviations make a robot an obstacle to all ([`crate::Deviation`]); this only names what is wrong.

use crate::Predictor;
use std::collections::VecDeque;
use trench_core::RosTime;
use trench_formation::kinematics::{Pose, Twist};

/// Over which motion is compared, s.
const WINDOW: f64 = 0.25;
/// Frames further apart than this say nothing of what is between, s.
const GAP: f64 = 0.1;
/// So many frames in a row must say it: about a tenth of a second.
const PATIENCE: u32 = 3;
/// What wheels that are driven below their slowest speed now and then are off by (4.6.3), m and rad.
const DITHER: [f64; 2] = [0.5e-3, 0.01];
/// Share of the way by which wheels are measured and calibrated wrongly at most.
const SCALE: f64 = 0.08;
/// By how long a command may act earlier or later than expected (two packets lost, a loop slower than measured), s.
const TIMING: f64 = 0.07;

/// Compares the poses that were seen with the commands in between.
#[derive(Debug, Clone, Default)]
pub struct Following {
    seen: VecDeque<(RosTime, Pose)>,
    strayed: u32,
}

impl Following {
    /// The robot was not seen, or does not drive.
    pub fn restart(&mut self) {
        *self = Self::default();
    }

    /// Takes the pose seen at `exposure`; whether the robot has moved otherwise than it was told.
    pub fn observe(&mut self, exposure: RosTime, pose: Pose, told: &Predictor) -> bool {
        if self.seen.back().is_some_and(|(last, _)| exposure <= *last) {
            return self.strayed >= PATIENCE;
        }
        if self.seen.back().is_some_and(|(last, _)| exposure.seconds_since(*last) > GAP) {
            self.restart();
        }
        while self.seen.get(1).is_some_and(|(then, _)| exposure.seconds_since(*then) >= WINDOW) {
            self.seen.pop_front();
        }
        if let Some((then, before)) = self.seen.front() {
            let strays = strays(*before, pose, told, (*then, exposure));
            self.strayed = if strays { self.strayed + 1 } else { 0 };
        }
        self.seen.push_back((exposure, pose));
        self.strayed >= PATIENCE
    }
}

/// Whether a robot that was at `before` and is at `now` has moved otherwise than it was told.
fn strays(before: Pose, now: Pose, told: &Predictor, (from, until): (RosTime, RosTime)) -> bool {
    let expected = told.predict(before, from, until);
    let apart = now.position() - expected.position();
    let turned = libm::remainder(now.theta - expected.theta, std::f64::consts::TAU);
    let way = (expected.position() - before.position()).norm();
    let turn = libm::remainder(expected.theta - before.theta, std::f64::consts::TAU);
    // What acts within TIMING of the window may have acted in it.
    let (from, until) = (from.plus_seconds(-TIMING), until.plus_seconds(TIMING));
    let spread = told.between(from, until).fold([told.in_force(from); 2], |[least, most], twist| {
        [
            Twist { v: least.v.min(twist.v), omega: least.omega.min(twist.omega) },
            Twist { v: most.v.max(twist.v), omega: most.omega.max(twist.omega) },
        ]
    });
    let [least, most] = spread;
    apart.norm() > DITHER[0] + SCALE * way + TIMING * (most.v - least.v)
        || turned.abs() > DITHER[1] + SCALE * turn.abs() + TIMING * (most.omega - least.omega)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(frame: u32) -> RosTime {
        RosTime(0).plus_seconds(f64::from(frame) / 30.0)
    }

    /// The frame in which a robot is said to stray that is told `twist` and does `done` of it from frame 30 on.
    fn found(twist: impl Fn(u32) -> Twist, done: impl Fn(Twist) -> Twist) -> Option<u32> {
        let (mut following, mut told) = (Following::default(), Predictor::default());
        let mut pose = Pose::new(0.0, 0.0, 0.0);
        (0..90).find(|frame| {
            let strays = following.observe(at(*frame), pose, &told);
            told.sent(at(*frame), twist(*frame));
            let moved = if *frame < 30 { twist(*frame) } else { done(twist(*frame)) };
            pose = pose.advanced(moved, 1.0 / 30.0);
            strays
        })
    }

    #[test]
    fn a_stuck_robot_and_a_slipping_wheel_are_named_within_a_third_of_a_second() {
        let slowly = |_| Twist { v: 0.03, omega: 0.05 };
        assert!(found(slowly, |_| Twist::ZERO).is_some_and(|frame| (31..=40).contains(&frame)));
        let left_slips = |twist: Twist| {
            let (left, right) = (0.7 * (twist.v - 0.06 * twist.omega), twist.v + 0.06 * twist.omega);
            Twist { v: 0.5 * (left + right), omega: (right - left) / 0.12 }
        };
        assert!(found(slowly, left_slips).is_some_and(|frame| (31..=40).contains(&frame)));
        assert_eq!(found(slowly, |twist| twist), None);
    }

    #[test]
    fn a_command_that_acts_late_is_followed() {
        let starts =
            |frame: u32| Twist { v: 0.005 * f64::from(frame.min(40)), omega: if frame > 20 { 1.0 } else { 0.0 } };
        let late = |frame: u32| starts(frame.saturating_sub(1));
        let (mut following, mut told) = (Following::default(), Predictor::default());
        let mut pose = Pose::new(0.0, 0.0, 0.0);
        for frame in 0..90 {
            assert!(!following.observe(at(frame), pose, &told), "frame {frame}");
            told.sent(at(frame), starts(frame));
            pose = pose.advanced(late(frame), 1.0 / 30.0);
        }
    }

    #[test]
    fn a_gap_forgets() {
        let (mut following, told) = (Following::default(), Predictor::default());
        for frame in 0..30 {
            let pose = Pose::new(if frame < 15 { 0.0 } else { 1.0 }, 0.0, 0.0);
            let time = at(if frame < 15 { frame } else { frame + 10 });
            assert!(!following.observe(time, pose, &told), "frame {frame}");
        }
    }
}
