//! The two clocks (invariant 9).

use trench_msgs::builtin_interfaces::{Duration, Time};

/// ROS time in nanoseconds since its epoch: the system clock, or /clock with `use_sim_time`. Control uses it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct RosTime(pub i64);

/// Monotonic time in nanoseconds since an arbitrary start, the same for all processes of a host. Every safety time-out
/// uses it: a paused /clock or a jump of the wall clock never keeps a robot driving.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Steady(pub u64);

/// When an event reached the core.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Times {
    /// ROS time at receipt.
    pub ros: RosTime,
    /// Monotonic time at receipt.
    pub steady: Steady,
}

/// What a message tells of has not been yet: it is so far ahead of our clock, s.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("it is {0:.3} s from the future")]
pub struct FromTheFuture(pub f64);

impl Times {
    /// What was seen so far ahead of our clock, s, was stamped by a wrong one: those after it would be older.
    pub const FUTURE: f64 = 0.5;

    /// Who tells of what was longer ago than this, s, is not who robots are driven by now.
    pub const PAST: f64 = 1.0;

    /// Whether what was stamped so can have been by now. While ROS time is zero nobody knows (/clock has not begun).
    ///
    /// # Errors
    /// How far ahead it is, if that is more than [`Self::FUTURE`].
    pub fn timely(self, stamp: RosTime) -> Result<(), FromTheFuture> {
        let ahead = stamp.seconds_since(self.ros);
        if self.ros != RosTime(0) && ahead > Self::FUTURE { Err(FromTheFuture(ahead)) } else { Ok(()) }
    }

    /// Whether `stamp` is longer ago than [`Self::PAST`]. While ROS time is zero nobody knows.
    #[must_use]
    pub fn is_past(self, stamp: RosTime) -> bool {
        self.ros != RosTime(0) && self.ros.seconds_since(stamp) > Self::PAST
    }
}

impl RosTime {
    /// Seconds from `earlier` to this time, negative if it is later.
    #[must_use]
    pub fn seconds_since(self, earlier: Self) -> f64 {
        self.0.saturating_sub(earlier.0) as f64 * 1e-9
    }

    /// This time moved by `seconds`.
    #[must_use]
    pub fn plus_seconds(self, seconds: f64) -> Self {
        Self(self.0.saturating_add((seconds * 1e9) as i64))
    }
}

impl Steady {
    /// Seconds from `earlier` to this time; 0 if `earlier` is later.
    #[must_use]
    pub fn seconds_since(self, earlier: Self) -> f64 {
        self.0.saturating_sub(earlier.0) as f64 * 1e-9
    }

    /// This time moved forward by `seconds` (0 if negative).
    #[must_use]
    pub fn plus_seconds(self, seconds: f64) -> Self {
        Self(self.0.saturating_add((seconds.max(0.0) * 1e9) as u64))
    }
}

impl From<&Time> for RosTime {
    fn from(time: &Time) -> Self {
        Self(i64::from(time.sec) * 1_000_000_000 + i64::from(time.nanosec))
    }
}

impl From<RosTime> for Time {
    fn from(time: RosTime) -> Self {
        // Seconds outside 32 bits cannot be said in a ROS message: saturate rather than wrap to another era.
        let seconds = time.0.div_euclid(1_000_000_000).clamp(i64::from(i32::MIN), i64::from(i32::MAX));
        Self { sec: seconds as i32, nanosec: time.0.rem_euclid(1_000_000_000) as u32 }
    }
}

/// A duration message from seconds.
#[must_use]
pub fn duration_from_seconds(seconds: f64) -> Duration {
    let nanoseconds = (seconds * 1e9) as i64;
    Duration {
        sec: nanoseconds.div_euclid(1_000_000_000) as i32,
        nanosec: nanoseconds.rem_euclid(1_000_000_000) as u32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_future_is_known_once_there_is_a_time() {
        let timely = |now: f64, stamp: f64| {
            let at = Times { ros: RosTime(0).plus_seconds(now), steady: Steady(0) };
            at.timely(RosTime(0).plus_seconds(stamp))
        };
        assert_eq!(timely(100.0, 100.4), Ok(()));
        assert_eq!(timely(100.0, -3600.0), Ok(()), "how old it is others say");
        assert_eq!(timely(100.0, 100.9).unwrap_err().to_string(), "it is 0.900 s from the future");
        assert_eq!(timely(0.0, 100.9), Ok(()));
    }
}
