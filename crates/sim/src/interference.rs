//! Bursts of interference: for a while nobody hears anybody.

use crate::Random;

/// How often and how long the air is jammed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bursts {
    /// Mean time from the end of a burst to the next, s; infinite: there is none.
    pub every: f64,
    /// Mean length of a burst, s.
    pub length: f64,
}

impl Bursts {
    /// Never.
    pub const NONE: Self = Self { every: f64::INFINITY, length: 0.0 };
}

/// Bursts under way. Both lengths are drawn from exponential distributions (Gilbert's channel in continuous time).
#[derive(Debug, Clone)]
pub(crate) struct Interference {
    bursts: Bursts,
    random: Random,
    /// Whether it is jammed, and until when that stays, ns.
    state: (bool, u64),
}

impl Interference {
    /// Quiet at `now` (ns).
    pub(crate) fn new(bursts: Bursts, random: Random, now: u64) -> Self {
        let mut interference = Self { bursts, random, state: (true, now) };
        interference.turn();
        interference
    }

    /// Other bursts from `now` on, at first quiet.
    pub(crate) fn set(&mut self, bursts: Bursts, now: u64) {
        if bursts != self.bursts {
            (self.bursts, self.state) = (bursts, (true, now));
            self.turn();
        }
    }

    /// Whether the air is jammed at `now`, which never goes back.
    pub(crate) fn jams(&mut self, now: u64) -> bool {
        while self.state.1 <= now {
            self.turn();
        }
        self.state.0
    }

    /// From quiet to jammed or back, at the end of the present state.
    fn turn(&mut self) {
        let (jammed, since) = self.state;
        let mean = if jammed { self.bursts.every } else { self.bursts.length };
        let lasts = -mean * libm::log(1.0 - self.random.unit());
        // At least a nanosecond, so that time goes on; a length that is infinite or not a number never ends.
        let lasts = if lasts.is_finite() { (lasts * 1e9) as u64 } else { u64::MAX };
        self.state = (!jammed, since.saturating_add(lasts.max(1)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_air_is_jammed_for_its_share_of_time() {
        let mut interference = Interference::new(Bursts { every: 3.0, length: 1.0 }, Random::new(1, 2), 0);
        let jammed = (0..1_000_000_u64).filter(|step| interference.jams(step * 10_000_000)).count();
        assert!((0.23..0.27).contains(&(jammed as f64 / 1e6)), "{jammed}");
    }

    #[test]
    fn without_bursts_it_is_quiet_and_a_change_holds_at_once() {
        let mut interference = Interference::new(Bursts::NONE, Random::new(1, 2), 0);
        assert!(!interference.jams(u64::MAX - 1));
        let mut interference = Interference::new(Bursts::NONE, Random::new(1, 2), 0);
        interference.set(Bursts { every: 1e-3, length: f64::INFINITY }, 1_000_000_000);
        assert!(interference.jams(2_000_000_000));
    }
}
