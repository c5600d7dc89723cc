//! The emergency stop: sticky, and cleared by the operator's reset alone.
//!
//! A publisher that has just come is a hand on the button: its first word can be late by the 3 s of a DDS writer's
//! heartbeat (docs/decisions/0001-transport.md). Until it speaks, and for at most [`HAND_ON_BUTTON`], robots rest.

use std::collections::BTreeMap;
use trench_core::Steady;

/// How long a publisher of /emergency_stop that says nothing holds the robots, s.
const HAND_ON_BUTTON: f64 = 3.5;

/// Who says what about stopping.
#[derive(Debug, Clone, Default)]
pub(crate) struct EmergencyStop {
    active: bool,
    /// The last word of each publisher, with the order in which they spoke.
    words: BTreeMap<[u8; 16], (u64, bool)>,
    spoken: u64,
    /// Publishers alive.
    writers: usize,
    /// Since when one of them has not spoken.
    silent_since: Option<Steady>,
}

impl EmergencyStop {
    /// As it was left by an earlier life of the node.
    pub(crate) fn restored(active: bool) -> Self {
        Self { active, ..Self::default() }
    }

    /// Whether robots are held.
    pub(crate) fn active(&self) -> bool {
        self.active
    }

    /// A publisher spoke. Gives whether this begins a stop.
    pub(crate) fn hear(&mut self, publisher: [u8; 16], stop: bool) -> bool {
        self.spoken += 1;
        self.words.insert(publisher, (self.spoken, stop));
        let begins = stop && !self.active;
        self.active |= stop;
        if self.words.len() >= self.writers {
            self.silent_since = None;
        }
        begins
    }

    /// Whether a publisher has come that has not spoken yet.
    pub(crate) fn reached_for(&self, now: Steady) -> bool {
        self.silent_since.is_some_and(|since| now.seconds_since(since) < HAND_ON_BUTTON)
    }

    /// A publisher has gone, and what it said with it.
    pub(crate) fn left(&mut self, publisher: [u8; 16]) {
        self.words.remove(&publisher);
    }

    /// So many publishers are alive: of those known, the ones that have been silent for longest are presumed gone where nobody says
    /// who it was.
    pub(crate) fn writers(&mut self, count: usize, now: Steady) {
        let came = count > self.writers;
        self.writers = count;
        while self.words.len() > count {
            let longest_silent = self.words.iter().min_by_key(|(_, (spoken, _))| *spoken).map(|(gid, _)| *gid);
            if let Some(gid) = longest_silent {
                self.words.remove(&gid);
            }
        }
        if self.words.len() >= count {
            self.silent_since = None;
        } else if came {
            self.silent_since = Some(now);
        }
    }

    /// The operator wants to go on.
    ///
    /// # Errors
    /// While a publisher still says stop.
    pub(crate) fn reset(&mut self) -> Result<(), &'static str> {
        if self.words.values().any(|(_, stop)| *stop) {
            return Err("refused: a publisher of /emergency_stop still says true; let it say false or end it");
        }
        self.active = false;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sticks_until_reset_and_resets_only_when_all_agree() {
        let (button, keyboard) = ([1; 16], [2; 16]);
        let mut stop = EmergencyStop::default();
        assert!(!stop.hear(keyboard, false));
        assert!(stop.hear(button, true));
        assert!(!stop.hear(button, true), "it began before");
        assert!(stop.reset().is_err() && stop.active());
        stop.hear(button, false);
        assert!(stop.active(), "only the reset clears it");
        assert!(stop.reset().is_ok() && !stop.active());
        stop.hear(button, true);
        stop.writers(2, Steady(0));
        assert!(stop.reset().is_err());
        // Who has gone is known: not the one that has been silent for longest.
        stop.hear(keyboard, false);
        stop.left(keyboard);
        stop.writers(1, Steady(0));
        assert!(stop.reset().is_err(), "the button still says stop");
        stop.writers(0, Steady(0));
        assert!(stop.active() && stop.reset().is_ok() && !stop.active());
    }

    #[test]
    fn a_hand_on_the_button_holds_the_robots_until_it_speaks() {
        let after = |seconds: f64| Steady(0).plus_seconds(seconds);
        let mut stop = EmergencyStop::default();
        assert!(!stop.reached_for(after(0.0)), "nobody is there");
        stop.writers(1, after(1.0));
        assert!(stop.reached_for(after(1.0)) && stop.reached_for(after(4.4)));
        assert!(!stop.reached_for(after(4.6)), "somebody who never speaks does not hold them for ever");
        stop.writers(2, after(10.0));
        stop.hear([1; 16], false);
        assert!(stop.reached_for(after(10.1)), "the other one has not spoken");
        stop.hear([2; 16], false);
        assert!(!stop.reached_for(after(10.1)) && !stop.active());
        stop.writers(1, after(11.0));
        stop.writers(2, after(12.0));
        assert!(stop.reached_for(after(12.0)));
        stop.writers(1, after(12.5));
        assert!(!stop.reached_for(after(12.5)), "it went without a word");
    }
}
