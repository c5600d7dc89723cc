//! How fast one may send.

use std::time::Duration;
use trench_core::Steady;

/// Keeps to a rate: what has been sent must have gone before the next may follow.
#[derive(Debug)]
pub(crate) struct Pace {
    /// s a byte.
    per_byte: f64,
    /// When all that was sent has gone at this rate.
    gone: Steady,
}

/// s, by which one may be ahead: to sleep for less costs more than it gains.
const AHEAD: f64 = 0.001;

impl Pace {
    /// At most so many bit/s.
    pub(crate) fn new(rate: f64) -> Self {
        Self { per_byte: 8.0 / rate, gone: Steady(0) }
    }

    /// So many bytes are to be sent: how long to wait before.
    pub(crate) fn wait(&mut self, now: Steady, bytes: usize) -> Duration {
        let ahead = self.gone.seconds_since(now);
        let wait = if ahead > AHEAD { ahead } else { 0.0 };
        self.gone = self.gone.max(now).plus_seconds(bytes as f64 * self.per_byte);
        Duration::from_secs_f64(wait)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_carries_what_the_rate_says_whatever_the_pieces() {
        let check = |rate: f64, bytes: usize| {
            let (mut pace, mut now, mut sent) = (Pace::new(rate), Steady(5_000_000_000), 0);
            let end = now.plus_seconds(1.0);
            while now < end {
                let wait = pace.wait(now, bytes);
                now = now.plus_seconds(wait.as_secs_f64());
                sent += bytes;
            }
            let allowed = rate / 8.0;
            let spare = allowed * AHEAD + 2.0 * bytes as f64;
            assert!((sent as f64 - allowed).abs() <= spare, "{rate} bit/s in pieces of {bytes}: {sent}");
        };
        check(256_000.0, 638);
        check(100_000.0, 1400);
        check(400.0e6, 1400);
    }

    #[test]
    fn who_was_silent_may_not_make_up_for_it() {
        let mut pace = Pace::new(80_000.0);
        assert_eq!(pace.wait(Steady(0), 1000), Duration::ZERO);
        let late = Steady(10_000_000_000);
        assert_eq!(pace.wait(late, 1000), Duration::ZERO);
        assert_eq!(pace.wait(late, 1000), Duration::from_millis(100));
        assert_eq!(Pace::new(f64::INFINITY).wait(late, 1_000_000), Duration::ZERO);
    }
}
