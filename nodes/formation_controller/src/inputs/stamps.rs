//! Messages from the past and from the future.

use crate::refusal::Refusal;
use trench_core::{RosTime, Times};

/// A stamp may be this far ahead of our clock, s.
const FUTURE: f64 = 0.05;

/// Whether a message of this stamp counts, received at `at` after one of the stamp `before`.
///
/// One from the future is never kept: all that come after it would be older. One older than `before` is late, unless `before` is itself
/// in the future now: then the clock was set back, or a bag begins anew.
///
/// # Errors
/// How far it is from the past or the future.
pub(crate) fn timely(at: Times, stamp: RosTime, before: Option<RosTime>) -> Result<(), Refusal> {
    let ahead = stamp.seconds_since(at.ros);
    if ahead > FUTURE {
        return Err(Refusal::Future(ahead));
    }
    let before = before.filter(|before| before.seconds_since(at.ros) <= FUTURE);
    match before.map(|before| before.seconds_since(stamp)) {
        Some(late) if late > 0.0 => Err(Refusal::Past(late)),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_core::Steady;

    #[test]
    fn late_ones_and_those_from_the_future() {
        let at = |seconds: f64| RosTime(0).plus_seconds(seconds);
        let check = |now: f64, stamp: f64, before: Option<f64>, expected: Result<(), Refusal>| {
            let times = Times { ros: at(now), steady: Steady(0) };
            assert_eq!(timely(times, at(stamp), before.map(at)), expected, "{now} {stamp} {before:?}");
        };
        check(10.0, 9.9, None, Ok(()));
        check(10.0, 9.9, Some(9.9), Ok(()));
        check(10.0, 9.5, Some(9.75), Err(Refusal::Past(0.25)));
        check(10.0, 1.0, Some(9.0), Err(Refusal::Past(8.0)));
        check(10.0, 10.25, Some(9.9), Err(Refusal::Future(0.25)));
        // The clock was set back by two seconds.
        check(8.0, 7.9, Some(9.9), Ok(()));
    }
}
