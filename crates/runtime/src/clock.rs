//! The two clocks of a process (architecture invariant 9).

use rustix::time::{ClockId, clock_gettime};
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use trench_core::{RosTime, Steady, Times};

/// Where ROS time comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Clock {
    /// The system's wall clock.
    System,
    /// /clock, with the last time it said; zero before the first.
    Simulated(RosTime),
    /// Another host's clock, by its measured distance from this host's monotonic one, ns. Nothing before the first
    /// measurement: the time is zero.
    Reference(Option<i64>),
}

impl Clock {
    /// For `use_sim_time`, and for whether it goes by another host's clock.
    pub(crate) fn new(use_sim_time: bool, by_reference: bool) -> Self {
        match (use_sim_time, by_reference) {
            (true, _) => Self::Simulated(RosTime::default()),
            (false, true) => Self::Reference(None),
            (false, false) => Self::System,
        }
    }

    /// Both times of this moment.
    pub(crate) fn now(self) -> Times {
        let steady = steady_now();
        let ros = match self {
            Self::System => wall_now(),
            Self::Simulated(time) => time,
            Self::Reference(offset) => {
                let at = |offset| i64::try_from(steady.0).unwrap_or(i64::MAX).saturating_add(offset);
                RosTime(offset.map_or(0, at))
            }
        };
        Times { ros, steady }
    }

    /// Takes the distance of the clock that this process goes by; without effect on the others.
    pub(crate) fn refer(&mut self, measured: i64) {
        if let Self::Reference(offset) = self {
            *offset = Some(measured);
        }
    }

    /// Takes a time from /clock; without effect on the system's clock.
    pub(crate) fn set(&mut self, time: RosTime) {
        if let Self::Simulated(now) = self {
            *now = time;
        }
    }
}

/// The system's wall clock. It is asked through the C library, so that what stands in between (libfaketime) is heard.
pub(crate) fn wall_now() -> RosTime {
    let nanoseconds = |time: Duration| i64::try_from(time.as_nanos()).unwrap_or(i64::MAX);
    RosTime(match SystemTime::now().duration_since(UNIX_EPOCH) {
        Ok(after) => nanoseconds(after),
        Err(before) => -nanoseconds(before.duration()),
    })
}

/// The monotonic clock that all processes of a host share.
pub(crate) fn steady_now() -> Steady {
    let time = clock_gettime(ClockId::Monotonic);
    Steady(u64::try_from(time.tv_sec.saturating_mul(1_000_000_000).saturating_add(time.tv_nsec)).unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simulated_time_stands_until_told_and_steady_time_goes_on() {
        let mut clock = Clock::new(true, false);
        let first = clock.now();
        assert_eq!(first.ros, RosTime(0));
        clock.set(RosTime(7));
        let second = clock.now();
        assert_eq!(second.ros, RosTime(7));
        assert!(second.steady >= first.steady);
    }

    #[test]
    fn the_time_of_another_host_is_zero_until_measured_and_goes_with_the_monotonic_clock() {
        let mut clock = Clock::Reference(None);
        assert_eq!(clock.now().ros, RosTime(0));
        clock.refer(1_000_000);
        let now = clock.now();
        assert_eq!(now.ros.0, now.steady.0 as i64 + 1_000_000);
    }

    #[test]
    fn the_system_clock_cannot_be_set() {
        let mut clock = Clock::new(false, false);
        clock.set(RosTime(7));
        assert!(clock.now().ros > RosTime(1_600_000_000_000_000_000));
    }
}
