//! One writer at a time on a topic that robots are driven by.
//!
//! Who says what cannot count, as no number, the future or what is long past, takes nobody's place by it: look at a message between
//! [`Master::check`] and [`Master::pin`].

use crate::{Source, Steady};

/// Why a message does not count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("another publisher writes this topic; this one is heard once that one has been silent for a while")]
pub struct NotMaster;

/// The writer that counts: the one heard first, until it has been silent for a while. Two nodes that say different things at
/// once would have robots do both by turns.
#[derive(Debug, Clone, Copy, Default)]
pub struct Master {
    pinned: Option<([u8; 16], Steady)>,
    /// When another one was heard first since the master's last word.
    challenged: Option<Steady>,
}

impl Master {
    /// How long a writer must be silent before another one is heard, s.
    pub const SILENCE: f64 = 0.5;
    /// For how much of that time the other one must have been heard already, s. A machine that stood still for a moment finds words
    /// of both, and whose come first is chance.
    pub const GRACE: f64 = 0.1;

    /// Takes a message of `source` that came at `now`.
    ///
    /// # Errors
    /// When somebody else is the master.
    pub fn admit(&mut self, source: Source, now: Steady) -> Result<(), NotMaster> {
        self.check(source, now, Self::SILENCE)?;
        self.pin(source, now);
        Ok(())
    }

    /// Whether `source` is the master or, after so many seconds of silence, may become it.
    ///
    /// # Errors
    /// When somebody else is the master.
    pub fn check(&mut self, source: Source, now: Steady, silence: f64) -> Result<(), NotMaster> {
        let Some((_, heard)) = self.pinned.filter(|(gid, _)| *gid != source.gid) else { return Ok(()) };
        let challenged = *self.challenged.get_or_insert(now);
        if now.seconds_since(heard) <= silence || now.seconds_since(challenged) < Self::GRACE {
            return Err(NotMaster);
        }
        Ok(())
    }

    /// Makes `source` the master, or hears it again.
    pub fn pin(&mut self, source: Source, now: Steady) {
        (self.pinned, self.challenged) = (Some((source.gid, now)), None);
    }

    /// Whether `source` is the master.
    #[must_use]
    pub fn is(&self, source: Source) -> bool {
        self.pinned.is_some_and(|(gid, _)| gid == source.gid)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Writers and times in hundredths of a second, and who of them is heard.
    fn heard<const N: usize>(said: [(u8, u64); N]) -> [bool; N] {
        let mut master = Master::default();
        said.map(|(name, hundredths)| {
            let source = Source { gid: [name; 16], sequence: 1 };
            master.admit(source, Steady(hundredths * 10_000_000)).is_ok()
        })
    }

    #[test]
    fn the_second_waits_until_the_first_is_silent() {
        let said = [(1, 0), (2, 10), (1, 40), (2, 80), (2, 90), (2, 91), (1, 110), (2, 120), (2, 200)];
        assert_eq!(heard(said), [true, false, true, false, false, true, false, true, true]);
    }

    /// After a moment in which nobody was heard the master goes on, whoever comes first; one that has taken its place is heard
    /// a tenth of a second after its first word.
    #[test]
    fn who_comes_first_after_a_pause_does_not_take_over() {
        let said = [(1, 0), (2, 1), (1, 3), (2, 70), (2, 70), (1, 70), (2, 72), (1, 73), (2, 200), (2, 205), (2, 210)];
        let goes_on = [true, false, true, false, false, true, false, true, false, false, true];
        assert_eq!(heard(said), goes_on);
    }
}
