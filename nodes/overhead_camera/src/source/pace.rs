//! When recorded frames are due.

use trench_core::{RosTime, Steady, Times};

/// Counts recorded time against the monotonic clock from a start.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pace {
    start: Steady,
}

/// Frames later than this, s, are not hurried after: the whole rest is as late.
const LATE: f64 = 0.1;

impl Pace {
    pub(super) fn start(&mut self, at: Steady) {
        self.start = at;
    }

    /// When what is recorded `offset` (s) after the start is due.
    pub(super) fn due(&self, offset: f64) -> Steady {
        self.start.plus_seconds(offset)
    }

    /// The ROS time at which what is due at `due` is taken to have come, if it is `now`; nothing if it is too early.
    pub(super) fn arrival(&mut self, due: Steady, now: Times) -> Option<RosTime> {
        if now.steady < due {
            return None;
        }
        let late = now.steady.seconds_since(due);
        if late <= LATE {
            return Some(now.ros.plus_seconds(-late));
        }
        self.start = self.start.plus_seconds(late);
        Some(now.ros)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_delays_do_not_show_and_great_ones_shift_the_rest() {
        let mut pace = Pace::default();
        pace.start(Steady(1_000_000_000));
        let mut check = |offset: f64, milliseconds: u64, expected: Option<i64>| {
            let ros = RosTime(7_000_000_000 + 1_000_000 * milliseconds as i64);
            let now = Times { ros, steady: Steady(1_000_000 * milliseconds) };
            let due = pace.due(offset);
            assert_eq!(pace.arrival(due, now).map(|time| time.0 / 1_000_000 - 7000), expected, "{offset} s");
        };
        check(0.0, 999, None);
        check(0.0, 1000, Some(1000));
        check(0.04, 1043, Some(1040));
        check(0.08, 1280, Some(1280));
        // 200 ms late for good.
        check(0.12, 1319, None);
        check(0.12, 1321, Some(1320));
    }
}
