//! The two clocks of a process (architecture invariant 9).

use rustix::time::{ClockId, Timespec, clock_gettime};
use trench_core::{RosTime, Steady, Times};

/// Where ROS time comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Clock {
    /// The system's wall clock.
    System,
    /// /clock, with the last time it said; zero before the first.
    Simulated(RosTime),
}

impl Clock {
    /// For `use_sim_time`.
    pub(crate) fn new(use_sim_time: bool) -> Self {
        if use_sim_time { Self::Simulated(RosTime::default()) } else { Self::System }
    }

    /// Both times of this moment.
    pub(crate) fn now(self) -> Times {
        let ros = match self {
            Self::System => RosTime(nanoseconds(clock_gettime(ClockId::Realtime))),
            Self::Simulated(time) => time,
        };
        Times { ros, steady: steady_now() }
    }

    /// Takes a time from /clock; without effect on the system's clock.
    pub(crate) fn set(&mut self, time: RosTime) {
        if let Self::Simulated(now) = self {
            *now = time;
        }
    }
}

/// The monotonic clock that all processes of a host share.
pub(crate) fn steady_now() -> Steady {
    Steady(u64::try_from(nanoseconds(clock_gettime(ClockId::Monotonic))).unwrap_or(0))
}

fn nanoseconds(time: Timespec) -> i64 {
    time.tv_sec.saturating_mul(1_000_000_000).saturating_add(time.tv_nsec)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simulated_time_stands_until_told_and_steady_time_goes_on() {
        let mut clock = Clock::new(true);
        let first = clock.now();
        assert_eq!(first.ros, RosTime(0));
        clock.set(RosTime(7));
        let second = clock.now();
        assert_eq!(second.ros, RosTime(7));
        assert!(second.steady >= first.steady);
    }

    #[test]
    fn the_system_clock_cannot_be_set() {
        let mut clock = Clock::new(false);
        clock.set(RosTime(7));
        assert!(clock.now().ros > RosTime(1_600_000_000_000_000_000));
    }
}
