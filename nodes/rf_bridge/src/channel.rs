//! Whether the air loses more packets than it does by chance: Page's test over what all robots report, and whether they do.
//!
//! E. S. Page, Continuous inspection schemes, Biometrika 41 (1954). Of all tests that raise a false alarm as rarely this one
//! finds a change soonest. One robot's 30 packets a second would need a second; a team's tell within a third of one. What its
//! reports say comes later the more of them are lost; that one did not come in its slot is known at once.

use trench_core::Steady;

/// Shares of packets lost between which it decides: in order, and not.
const ORDINARY: f64 = 0.03;
const BAD: f64 = 0.25;

/// Natural logarithm of the likelihood ratio at which it decides. Where 3 % are lost 2.4 million packets, four hours of four
/// robots, pass on average before an alarm that is none; where 5 % are, four minutes.
const ALARM: f64 = 12.0;

/// Without anything to do for so long, s, the bridge was held up, and reports may have been lost on its own threshold.
const HELD_UP: f64 = 0.25;

/// What came while it was held up is read within this time, s.
const CATCHING_UP: f64 = 0.05;

/// More evidence than this is not kept, so that the end is found as soon as the beginning.
const MOST: f64 = 2.0 * ALARM;

/// What reports have said so far.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Channel {
    evidence: f64,
    bad: bool,
    /// Since when the bridge hears whatever comes, and until when it is known to.
    attentive: (Steady, Steady),
    /// The last time without anything to do, s, and when it ended.
    idle: (f64, Steady),
}

impl Channel {
    /// Takes what became of packets to one robot; gives whether that changes the answer.
    pub(crate) fn hear(&mut self, received: u64, lost: u64) -> bool {
        let of_lost = libm::log(BAD / ORDINARY);
        let of_received = libm::log((1.0 - BAD) / (1.0 - ORDINARY));
        let gained = lost as f64 * of_lost + received as f64 * of_received;
        self.evidence = (self.evidence + gained).clamp(0.0, MOST);
        let bad = self.evidence >= ALARM || (self.bad && self.evidence > 0.0);
        std::mem::replace(&mut self.bad, bad) != bad
    }

    /// The bridge does something: it was not held up.
    pub(crate) fn attend(&mut self, now: Steady) {
        let (since, until) = self.attentive;
        let idle = now.seconds_since(until);
        self.attentive = (if idle > HELD_UP { now } else { since }, now);
        if idle > self.idle.0 || now.seconds_since(self.idle.1) > CATCHING_UP {
            self.idle = (idle, now);
        }
    }

    /// From when on no report is missed by the bridge's own fault.
    pub(crate) fn attentive_since(&self) -> Steady {
        self.attentive.0
    }

    /// For how long, s, what is read now may have waited because the bridge was held up; 0 where it did something in every
    /// `heartbeat` seconds, as it wants to.
    pub(crate) fn held_up(&self, now: Steady, heartbeat: f64) -> f64 {
        let (idle, ended) = self.idle;
        if idle > 1.2 * heartbeat && now.seconds_since(ended) <= CATCHING_UP { idle } else { 0.0 }
    }

    /// Whether it is bad; good again once all evidence of the contrary is outweighed.
    pub(crate) fn is_bad(&self) -> bool {
        self.bad
    }
}

#[cfg(test)]
mod tests {
    use super::{Channel, Steady};

    /// Packets, of which every `nth` is lost, until the answer is `bad`.
    fn until(channel: &mut Channel, nth: u64, bad: bool) -> Option<u64> {
        (1..100_000_u64).find(|packet| {
            let lost = u64::from(packet.is_multiple_of(nth));
            channel.hear(1 - lost, lost);
            channel.is_bad() == bad
        })
    }

    #[test]
    fn who_was_held_up_knows_of_nothing_before() {
        let mut channel = Channel::default();
        for ms in [1000, 1100, 1200, 2200, 2300] {
            channel.attend(Steady(ms * 1_000_000));
        }
        assert_eq!(channel.attentive_since(), Steady(2_200_000_000));
    }

    #[test]
    fn heavy_loss_is_found_within_forty_packets_and_so_is_its_end() {
        let mut channel = Channel::default();
        assert_eq!(until(&mut channel, 33, true), None, "as usual");
        assert_eq!(until(&mut channel, 14, true), None, "7 %");
        assert!(until(&mut channel, 3, true).is_some_and(|packets| packets <= 40), "a third");
        let end = until(&mut channel, 33, false);
        assert!(end.is_some_and(|packets| packets <= 80), "{end:?}");
        let mut channel = Channel::default();
        assert!(until(&mut channel, 2, true).is_some_and(|packets| packets <= 16), "half");
    }
}
