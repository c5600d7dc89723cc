//! The emergency stop: sticky, and cleared by the operator's reset alone.
//!
//! A publisher that has just come is a hand on the button: its first word can be late by the 3 s of a DDS writer's
//! heartbeat (docs/decisions/0001-transport.md). Until it speaks, and for at most [`HAND_ON_BUTTON`], robots rest.

use std::collections::{BTreeMap, BTreeSet};
use trench_core::Steady;

/// How long a publisher of /emergency_stop that says nothing holds the robots, s.
const HAND_ON_BUTTON: f64 = 3.5;

/// What a word leads to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum News {
    /// A stop begins.
    Begins,
    /// Others say stop than before.
    Words,
}

/// Who says what about stopping.
#[derive(Debug, Clone, Default)]
pub(crate) struct EmergencyStop {
    active: bool,
    /// The last word of each publisher, with the order in which they spoke.
    words: BTreeMap<[u8; 16], (u64, bool)>,
    spoken: u64,
    /// Who said stop to an earlier life of the node, of whom the network has not yet said whether they are there.
    awaited: BTreeSet<[u8; 16]>,
    awaited_until: Option<Steady>,
    /// Publishers alive.
    writers: usize,
    /// Since when one of them has not spoken.
    silent_since: Option<Steady>,
}

impl EmergencyStop {
    /// As it was left by an earlier life of the node, to whom these publishers said stop; they need not say it again.
    pub(crate) fn restored(active: bool, said_stop: impl IntoIterator<Item = [u8; 16]>) -> Self {
        Self { active, awaited: said_stop.into_iter().collect(), ..Self::default() }
    }

    /// The network begins to tell who is there.
    pub(crate) fn start(&mut self, now: Steady) {
        self.awaited_until = Some(now.plus_seconds(HAND_ON_BUTTON));
    }

    /// Who says stop, as far as is known.
    pub(crate) fn said_stop(&self) -> impl Iterator<Item = [u8; 16]> {
        let saying = self.words.iter().filter(|(_, (_, stop))| *stop).map(|(publisher, _)| *publisher);
        saying.chain(self.awaited.iter().copied())
    }

    /// Whether robots are held.
    pub(crate) fn active(&self) -> bool {
        self.active
    }

    /// A publisher spoke.
    pub(crate) fn hear(&mut self, publisher: [u8; 16], stop: bool) -> Option<News> {
        self.spoken += 1;
        let before = self.words.insert(publisher, (self.spoken, stop));
        let said_stop = self.awaited.remove(&publisher) || before.is_some_and(|(_, stop)| stop);
        let begins = stop && !self.active;
        self.active |= stop;
        self.look_for_silence(None);
        let changes = (said_stop != stop).then_some(News::Words);
        if begins { Some(News::Begins) } else { changes }
    }

    /// Whether a publisher has come that has not spoken yet.
    pub(crate) fn reached_for(&self, now: Steady) -> bool {
        self.silent_since.is_some_and(|since| now.seconds_since(since) < HAND_ON_BUTTON)
    }

    /// A publisher is there, and what it said to an earlier life holds; or it has gone, and what it said with it.
    pub(crate) fn presence(&mut self, publisher: [u8; 16], is_there: bool) {
        let was_awaited = self.awaited.remove(&publisher);
        if !is_there {
            self.words.remove(&publisher);
        } else if was_awaited {
            self.words.insert(publisher, (0, true));
            self.look_for_silence(None);
        }
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
        self.look_for_silence(came.then_some(now));
    }

    /// Nobody reaches for the button any more once all have spoken; somebody does who `came`.
    fn look_for_silence(&mut self, came: Option<Steady>) {
        let all_have_spoken = self.words.len() >= self.writers;
        self.silent_since = if all_have_spoken { None } else { came.or(self.silent_since) };
    }

    /// The operator wants to go on.
    ///
    /// # Errors
    /// While a publisher still says stop, or may.
    pub(crate) fn reset(&mut self, now: Steady) -> Result<(), &'static str> {
        if self.awaited_until.is_none_or(|until| now >= until) {
            self.awaited.clear();
        } else if !self.awaited.is_empty() {
            return Err(
                "refused: a publisher of /emergency_stop said true before rf_bridge was started again and may still be there; \
                        ask again in some seconds",
            );
        }
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
        let now = Steady(0);
        assert_eq!(stop.hear(keyboard, false), None);
        assert_eq!(stop.hear(button, true), Some(News::Begins));
        assert_eq!(stop.hear(button, true), None, "it began before");
        assert!(stop.reset(now).is_err() && stop.active());
        assert_eq!(stop.hear(button, false), Some(News::Words));
        assert!(stop.active(), "only the reset clears it");
        assert!(stop.reset(now).is_ok() && !stop.active());
        stop.hear(button, true);
        stop.writers(2, now);
        assert!(stop.reset(now).is_err());
        // Who has gone is known: not the one that has been silent for longest.
        assert_eq!(stop.hear(keyboard, true), Some(News::Words));
        stop.presence(keyboard, false);
        stop.writers(1, now);
        assert!(stop.reset(now).is_err(), "the button still says stop");
        stop.writers(0, now);
        assert!(stop.active() && stop.reset(now).is_ok() && !stop.active());
    }

    /// A button that said stop once says it to the node's next life, too, if it is still there.
    #[test]
    fn who_said_stop_to_an_earlier_life_says_it_still_unless_it_has_gone() {
        let (button, after) = ([1; 16], |seconds: f64| Steady(0).plus_seconds(seconds));
        let anew = || {
            let mut stop = EmergencyStop::restored(true, [button]);
            stop.start(after(0.0));
            stop
        };
        let mut stop = anew();
        assert!(stop.reset(after(0.1)).is_err(), "nobody knows yet whether it is there");
        stop.writers(1, after(0.2));
        stop.presence(button, true);
        assert!(stop.reset(after(9.0)).is_err() && stop.said_stop().eq([button]));
        assert!(!stop.reached_for(after(0.3)), "it has spoken");
        assert_eq!(stop.hear(button, false), Some(News::Words));
        assert!(stop.reset(after(9.0)).is_ok());
        for (gone, at, granted) in [(true, 0.5, true), (false, 0.5, false), (false, 3.6, true)] {
            let mut stop = anew();
            if gone {
                stop.presence(button, false);
            }
            assert_eq!(stop.reset(after(at)).is_ok(), granted, "{gone} {at}");
        }
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
