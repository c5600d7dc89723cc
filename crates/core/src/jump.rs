//! A wall clock that somebody sets while nodes run.

use crate::Times;

/// Two looks at the clocks further apart than this tell nothing: a simulated clock may have gone on or rested meanwhile, ns.
const LOOK: u64 = 500_000_000;

/// What ROS time and monotonic time differ by in such a while is no drift, and no simulated clock that runs at another rate, ns.
const JUMP: i64 = 1_000_000_000;

/// Tells when ROS time jumped: whoever keeps a ROS time for long (when a run began) moves it along.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct JumpWatch {
    last: Option<Times>,
}

impl JumpWatch {
    /// Looks at the clocks, with every event of a node; gives by how many ns ROS time has jumped since the last look.
    pub fn look(&mut self, now: Times) -> Option<i64> {
        let last = self.last.replace(now)?;
        let steady = now.steady.0.saturating_sub(last.steady.0);
        // A simulated clock begins at zero.
        if steady > LOOK || last.ros.0 == 0 || now.ros.0 == 0 {
            return None;
        }
        jump_between(last, now)
    }
}

/// By how many ns the first clock of two looks went on by more than the monotonic one, if that is no drift.
#[must_use]
pub fn jump_between(last: Times, now: Times) -> Option<i64> {
    let steady = i64::try_from(now.steady.0.saturating_sub(last.steady.0)).unwrap_or(i64::MAX);
    let jump = now.ros.0.saturating_sub(last.ros.0).saturating_sub(steady);
    (jump.saturating_abs() > JUMP).then_some(jump)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{RosTime, Steady};

    const SECOND: i64 = 1_000_000_000;

    /// What is seen when looks are `apart` ns of the monotonic clock apart, in which ROS time goes on by `by`.
    fn seen(apart: u64, by: i64) -> Option<i64> {
        let mut watch = JumpWatch::default();
        let start = Times { ros: RosTime(100 * SECOND), steady: Steady(5) };
        assert_eq!(watch.look(start), None);
        watch.look(Times { ros: RosTime(start.ros.0 + by), steady: Steady(start.steady.0 + apart) })
    }

    #[test]
    fn jumps_are_told_and_drift_and_pauses_are_not() {
        assert_eq!(seen(30_000_000, 30_000_000 + 3600 * SECOND), Some(3600 * SECOND));
        assert_eq!(seen(30_000_000, 30_000_000 - 3600 * SECOND), Some(-3600 * SECOND));
        assert_eq!(seen(30_000_000, 31_000_000), None);
        assert_eq!(seen(400_000_000, 0), None, "/clock rests");
        assert_eq!(seen(15_000_000_000, 0), None, "/clock rested as long as this process");
        assert_eq!(seen(30_000_000, -100 * SECOND), None, "there is no time yet");
    }
}
