//! How far another host's clock is from this host's monotonic one, from exchanges of time stamps (as NTP does it).

use std::collections::VecDeque;
use trench_core::{RosTime, Steady};

/// How far two clocks may drift apart: crystals are within 100 parts in a million of each other.
const DRIFT: f64 = 100e-6;

/// Exchanges that are remembered.
const REMEMBERED: usize = 32;

/// One question and its answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Exchange {
    /// When this host asked.
    pub(crate) asked: Steady,
    /// When the other host heard it, by its clock.
    pub(crate) heard: RosTime,
    /// When it answered, by its clock.
    pub(crate) answered: RosTime,
    /// When the answer came.
    pub(crate) back: Steady,
}

/// What to add to this host's monotonic time to get the other's clock, and how wrong that may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Offset {
    /// Nanoseconds.
    pub(crate) offset: i64,
    /// Nanoseconds.
    pub(crate) bound: i64,
}

impl Offset {
    /// The most that the other clock may be ahead, ns: by it nothing looks younger than it is, however badly the clock is known.
    pub(crate) const fn latest(self) -> i64 {
        self.offset.saturating_add(self.bound)
    }
}

/// The exchanges of the last time.
#[derive(Debug, Default)]
pub(crate) struct Estimate {
    exchanges: VecDeque<(Offset, Steady)>,
}

impl Estimate {
    /// Takes an exchange. False if it shows that the other clock was set: then those before it are forgotten.
    pub(crate) fn add(&mut self, exchange: Exchange) -> bool {
        let Some(offset) = exchange.offset() else { return true };
        let known = self.at(exchange.back);
        let agrees = known.is_none_or(|known| {
            known.offset.saturating_sub(offset.offset).saturating_abs() <= known.bound.saturating_add(offset.bound)
        });
        if !agrees {
            self.exchanges.clear();
        }
        if self.exchanges.len() == REMEMBERED {
            self.exchanges.pop_front();
        }
        self.exchanges.push_back((offset, exchange.back));
        agrees
    }

    /// The best that is known at `now`: of the exchange with the smallest bound, which grows as it ages.
    pub(crate) fn at(&self, now: Steady) -> Option<Offset> {
        let aged = |(offset, at): &(Offset, Steady)| Offset {
            bound: offset.bound.saturating_add((now.seconds_since(*at) * DRIFT * 1e9) as i64),
            ..*offset
        };
        self.exchanges.iter().map(aged).min_by_key(|offset| offset.bound)
    }
}

impl Exchange {
    /// The answer came from somewhere within the time that the way took; in the middle it is least wrong. Nothing where
    /// the times contradict each other.
    fn offset(self) -> Option<Offset> {
        let nanoseconds = |steady: Steady| i64::try_from(steady.0).ok();
        let (asked, back) = (nanoseconds(self.asked)?, nanoseconds(self.back)?);
        let on_the_way = back.checked_sub(asked)?.checked_sub(self.answered.0.checked_sub(self.heard.0)?)?;
        let out = self.heard.0.checked_sub(asked)?;
        let home = self.answered.0.checked_sub(back)?;
        // The sum of two of these may not fit; their half does.
        let offset = out.checked_add(home.checked_sub(out)? / 2)?;
        (on_the_way >= 0 && self.answered >= self.heard).then_some(Offset { offset, bound: on_the_way / 2 + 1 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The other clock is ahead by this, ns.
    const AHEAD: i64 = 1_700_000_000_000_000_000;

    /// An exchange that begins at `at` ms, with its ways in us, while the other clock is `wrong` us off.
    fn exchange(at: u64, out: u64, home: u64, wrong: i64) -> Exchange {
        let asked = at * 1_000_000;
        let heard = asked + out * 1000;
        let answered = heard + 20_000;
        let by_other = |steady: u64| RosTime(steady as i64 + AHEAD + wrong * 1000);
        Exchange {
            asked: Steady(asked),
            heard: by_other(heard),
            answered: by_other(answered),
            back: Steady(answered + home * 1000),
        }
    }

    #[test]
    fn the_truth_is_within_the_bound_however_lopsided_the_way() {
        for (out, home) in [(100, 100), (5000, 10), (10, 5000), (0, 0)] {
            let mut estimate = Estimate::default();
            assert_eq!(estimate.at(Steady(0)), None);
            assert!(estimate.add(exchange(1, out, home, 0)));
            let known = estimate.at(Steady(2_000_000)).unwrap();
            assert!((known.offset - AHEAD).abs() <= known.bound, "{out} {home}: {known:?}");
            assert!(known.bound <= 1000 + (out + home) as i64 * 500, "{known:?}");
            assert!(
                (AHEAD..=AHEAD + 2 * known.bound).contains(&known.latest()),
                "nothing is older than it looks: {known:?}"
            );
        }
    }

    #[test]
    fn the_quickest_exchange_counts_until_it_is_old() {
        let mut estimate = Estimate::default();
        estimate.add(exchange(0, 50, 50, 0));
        estimate.add(exchange(1000, 4000, 100, 0));
        let soon = estimate.at(Steady(1_200_000_000)).unwrap();
        assert!(soon.bound < 200_000, "{soon:?}");
        // 30 s later the first may be off by 3 ms.
        estimate.add(exchange(30_000, 1000, 1000, 0));
        let later = estimate.at(Steady(30_100_000_000)).unwrap();
        assert!((1_000_000..1_200_000).contains(&later.bound), "{later:?}");
    }

    #[test]
    fn a_clock_that_was_set_is_believed_at_once() {
        let mut estimate = Estimate::default();
        assert!(estimate.add(exchange(0, 50, 50, 0)));
        assert!(!estimate.add(exchange(1000, 3000, 3000, 3_600_000_000)));
        let known = estimate.at(Steady(1_100_000_000)).unwrap();
        assert!((known.offset - AHEAD - 3_600_000_000_000).abs() <= known.bound);
    }

    #[test]
    fn times_that_contradict_each_other_are_no_exchange() {
        let good = exchange(5, 100, 100, 0);
        let mut estimate = Estimate::default();
        estimate.add(Exchange { back: Steady(0), ..good });
        estimate.add(Exchange { answered: RosTime(good.heard.0 - 1), ..good });
        estimate.add(Exchange { heard: RosTime(i64::MIN), ..good });
        estimate.add(Exchange { asked: Steady(u64::MAX), ..good });
        assert_eq!(estimate.at(good.back), None);
    }
}
