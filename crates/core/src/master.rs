//! One writer at a time on a topic that robots are driven by.

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
}

impl Master {
    /// How long a writer must be silent before another one is heard, s.
    pub const SILENCE: f64 = 0.5;

    /// Takes a message of `source` that came at `now`.
    ///
    /// # Errors
    /// When somebody else is the master.
    pub fn admit(&mut self, source: Source, now: Steady) -> Result<(), NotMaster> {
        let master = self.pinned.filter(|(_, heard)| now.seconds_since(*heard) <= Self::SILENCE);
        if master.is_some_and(|(gid, _)| gid != source.gid) {
            return Err(NotMaster);
        }
        self.pinned = Some((source.gid, now));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_waits_until_the_first_is_silent() {
        let source = |name: u8| Source { gid: [name; 16], sequence: 1 };
        let at = |tenths: u64| Steady(tenths * 100_000_000);
        let mut master = Master::default();
        let said = [(1, 0), (2, 1), (1, 4), (2, 8), (2, 9), (2, 10), (1, 11), (2, 12)];
        let heard = said.map(|(name, tenths)| master.admit(source(name), at(tenths)).is_ok());
        assert_eq!(heard, [true, false, true, false, false, true, false, true]);
    }
}
