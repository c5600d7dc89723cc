//! Which packets are new: replays, duplicates and stragglers are not obeyed.

/// Without a key, a sender that begins anew with small counters is believed after this silence, in ns.
const SESSION_SILENCE: u64 = 1_000_000_000;

/// The packet's counter is not above the last one's: it is a replay, a duplicate, or was overtaken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("counter {counter} is not above {last}")]
pub struct Stale {
    /// The packet's.
    pub counter: u64,
    /// The highest accepted before.
    pub last: u64,
}

/// Accepts each counter once, and only upwards.
#[derive(Debug, Clone, Copy, Default)]
pub struct Freshness {
    last: Option<(u64, u64)>,
}

impl Freshness {
    /// Accepts a packet's counter at time `now` (ns of any monotonic clock). `authenticated`: whether a tag vouches for
    /// the counter; then it may never go back, else only after a second of silence.
    ///
    /// # Errors
    /// When the packet is not new.
    pub fn accept(&mut self, counter: u64, now: u64, authenticated: bool) -> Result<(), Stale> {
        if let Some((last, at)) = self.last {
            let anew = !authenticated && now.saturating_sub(at) >= SESSION_SILENCE;
            if counter <= last && !anew {
                return Err(Stale { counter, last });
            }
        }
        self.last = Some((counter, now));
        Ok(())
    }

    /// Whatever was accepted before, this counter is the last one now.
    pub fn set(&mut self, counter: u64, now: u64) {
        self.last = Some((counter, now));
    }

    /// The last counter accepted and when.
    #[must_use]
    pub fn last(&self) -> Option<(u64, u64)> {
        self.last
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counters_go_up_only() {
        let mut freshness = Freshness::default();
        let mut check = |counter, now, authenticated, expected: Result<(), u64>| {
            let result = freshness.accept(counter, now, authenticated).map_err(|stale| stale.last);
            assert_eq!(result, expected, "counter {counter}");
        };
        check(100, 0, true, Ok(()));
        check(100, 1, true, Err(100));
        check(99, 2, true, Err(100));
        check(104, 3, true, Ok(()));
        check(1_000_000, 4, true, Ok(()));
        check(5, 3_000_000_000, true, Err(1_000_000));
        check(5, 3_000_000_000, false, Ok(()));
        check(4, 3_000_000_001, false, Err(5));
    }
}
