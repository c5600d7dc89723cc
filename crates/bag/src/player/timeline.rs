//! When a message of the bag is due.

use trench_core::Steady;

/// The bag's time as a function of the machine's: stands before it begins and while paused.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Timeline {
    /// The machine's time at which the bag's was `bag` ...
    steady: Steady,
    /// ... ns.
    bag: u64,
    rate: f64,
    is_paused: bool,
}

impl Timeline {
    /// Of a bag whose time is `bag` (ns) until `steady`, and goes on at `rate` from there.
    pub(super) fn new(steady: Steady, bag: u64, rate: f64, is_paused: bool) -> Self {
        Self { steady, bag, rate, is_paused }
    }

    /// The bag's time, ns.
    pub(super) fn now(&self, steady: Steady) -> u64 {
        if self.is_paused {
            return self.bag;
        }
        self.bag.saturating_add((steady.0.saturating_sub(self.steady.0) as f64 * self.rate) as u64)
    }

    /// When a message logged at `log_time` is to be published; never while paused.
    pub(super) fn due(&self, log_time: u64) -> Option<Steady> {
        let wait = (log_time.saturating_sub(self.bag) as f64 / self.rate).ceil() as u64;
        (!self.is_paused).then_some(Steady(self.steady.0.saturating_add(wait)))
    }

    pub(super) fn is_paused(&self) -> bool {
        self.is_paused
    }

    pub(super) fn rate(&self) -> f64 {
        self.rate
    }

    pub(super) fn pause(&mut self, steady: Steady, is_paused: bool) {
        (self.bag, self.steady) = (self.now(steady), self.steady.max(steady));
        self.is_paused = is_paused;
    }

    /// Goes on at another pace. Whether it is one.
    pub(super) fn set_rate(&mut self, steady: Steady, rate: f64) -> bool {
        let is_possible = rate.is_finite() && rate > 0.0;
        if is_possible {
            (self.bag, self.steady) = (self.now(steady), self.steady.max(steady));
            self.rate = rate;
        }
        is_possible
    }

    /// Goes on from another time of the bag, ns.
    pub(super) fn jump(&mut self, steady: Steady, bag: u64) {
        (self.bag, self.steady) = (bag, steady);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: u64 = 1_000_000_000;

    #[test]
    fn spacing_is_that_of_the_bag_divided_by_the_rate() {
        let check = |rate: f64, expected: u64| {
            let line = Timeline::new(Steady(7 * SECOND), 100 * SECOND, rate, false);
            assert_eq!(line.due(103 * SECOND), Some(Steady(expected)));
            assert_eq!(line.now(Steady(expected)), 103 * SECOND);
            assert_eq!(line.due(50 * SECOND), Some(Steady(7 * SECOND)), "what is before the beginning is due there");
            assert_eq!(line.now(Steady(0)), 100 * SECOND, "time stands before the beginning");
        };
        check(1.0, 10 * SECOND);
        check(2.0, 8 * SECOND + SECOND / 2);
        check(0.5, 13 * SECOND);
    }

    #[test]
    fn a_pause_moves_all_that_follows() {
        let mut line = Timeline::new(Steady(0), 0, 1.0, false);
        line.pause(Steady(2 * SECOND), true);
        assert_eq!((line.now(Steady(9 * SECOND)), line.due(5 * SECOND)), (2 * SECOND, None));
        line.pause(Steady(10 * SECOND), false);
        assert_eq!(line.due(5 * SECOND), Some(Steady(13 * SECOND)));
    }

    #[test]
    fn a_rate_holds_from_its_moment_on() {
        let mut line = Timeline::new(Steady(0), 0, 1.0, false);
        assert!(line.set_rate(Steady(2 * SECOND), 4.0));
        assert_eq!(line.due(6 * SECOND), Some(Steady(3 * SECOND)));
        assert!(!line.set_rate(Steady(3 * SECOND), 0.0) && !line.set_rate(Steady(3 * SECOND), f64::NAN));
        line.jump(Steady(5 * SECOND), SECOND);
        assert_eq!(line.due(5 * SECOND), Some(Steady(6 * SECOND)));
    }
}
