//! Exactly once, in order: what a reader has had from each writer (architecture invariant 3).

use std::collections::BTreeMap;
use trench_core::Source;

/// Writers remembered at once. More only ever live if hundreds of processes restart under one reader; then the one
/// whose last message is the oldest is forgotten.
const REMEMBERED: usize = 256;

#[derive(Debug, Clone, Copy)]
struct Writer {
    last: u64,
    used: u64,
    /// Whether the network was waited for in vain, and has not caught up since.
    network_lags: bool,
}

/// The last count delivered from each writer, whichever transport brought it.
///
/// A writer hands message n to shared memory before the network and both keep its order, so "above the last count" is
/// all there is to know: the second copy is dropped, and if one transport ends, the other goes on behind the last
/// delivered message.
#[derive(Debug, Default)]
pub(crate) struct Delivered {
    writers: BTreeMap<[u8; 16], Writer>,
    uses: u64,
    lost: u64,
}

impl Delivered {
    /// Whether a message is news. Does not yet count as its delivery.
    pub(crate) fn is_new(&self, source: Source) -> bool {
        self.writers.get(&source.gid).is_none_or(|writer| source.sequence > writer.last)
    }

    /// Whether this writer has been heard.
    pub(crate) fn knows(&self, gid: &[u8; 16]) -> bool {
        self.writers.contains_key(gid)
    }

    /// Whether messages of a writer that has been heard are still missing before this one.
    pub(crate) fn leaves_gap(&self, source: Source) -> bool {
        self.writers.get(&source.gid).is_some_and(|writer| source.sequence > writer.last + 1)
    }

    /// Whether the network may still bring what is missing before this message of shared memory.
    pub(crate) fn may_be_filled(&self, source: Source) -> bool {
        self.leaves_gap(source) && self.writers.get(&source.gid).is_some_and(|writer| !writer.network_lags)
    }

    /// The network did not bring in time what was missing before a message. Waiting for it again and again would cost
    /// more: what shared memory holds meanwhile overflows.
    pub(crate) fn give_up(&mut self, gid: &[u8; 16]) {
        if let Some(writer) = self.writers.get_mut(gid) {
            writer.network_lags = true;
        }
    }

    /// The network brought a message, new or a copy: it is worth waiting for once it has caught up.
    pub(crate) fn heard_over_network(&mut self, source: Source) {
        if let Some(writer) = self.writers.get_mut(&source.gid)
            && source.sequence >= writer.last
        {
            writer.network_lags = false;
        }
    }

    /// Takes a message if it is news; false for a copy of one that was delivered.
    pub(crate) fn accept(&mut self, source: Source) -> bool {
        if !self.is_new(source) {
            return false;
        }
        self.uses += 1;
        let network_lags = self.writers.get(&source.gid).is_some_and(|writer| writer.network_lags);
        let writer = Writer { last: source.sequence, used: self.uses, network_lags };
        if let Some(before) = self.writers.insert(source.gid, writer) {
            self.lost += source.sequence - before.last - 1;
        } else if self.writers.len() > REMEMBERED {
            self.forget_oldest();
        }
        true
    }

    /// How many counts were skipped since the last call by writers that had been heard before.
    pub(crate) fn take_lost(&mut self) -> u64 {
        std::mem::take(&mut self.lost)
    }

    fn forget_oldest(&mut self) {
        let oldest = self.writers.iter().min_by_key(|(_, writer)| writer.used).map(|(gid, _)| *gid);
        if let Some(gid) = oldest {
            self.writers.remove(&gid);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(writer: u8, sequence: u64) -> Source {
        Source { gid: [writer; 16], sequence }
    }

    #[test]
    fn copies_are_dropped_and_gaps_counted() {
        let mut delivered = Delivered::default();
        let check = |delivered: &mut Delivered, sequence, expected| {
            assert_eq!(delivered.accept(source(1, sequence)), expected, "{sequence}");
        };
        check(&mut delivered, 5, true);
        check(&mut delivered, 5, false);
        check(&mut delivered, 4, false);
        check(&mut delivered, 6, true);
        assert_eq!(delivered.take_lost(), 0, "what was sent before the first message is not lost");
        assert!(delivered.leaves_gap(source(1, 9)) && !delivered.leaves_gap(source(1, 7)));
        assert!(!delivered.leaves_gap(source(2, 9)), "an unknown writer's past is not missed");
        check(&mut delivered, 9, true);
        assert_eq!((delivered.take_lost(), delivered.take_lost()), (2, 0));
    }

    #[test]
    fn a_network_that_lags_is_waited_for_once() {
        let mut delivered = Delivered::default();
        assert!(delivered.accept(source(1, 1)));
        assert!(delivered.may_be_filled(source(1, 3)));
        assert!(!delivered.may_be_filled(source(1, 2)) && !delivered.may_be_filled(source(2, 7)), "no gap");
        delivered.give_up(&[1; 16]);
        assert!(delivered.accept(source(1, 3)));
        assert!(!delivered.may_be_filled(source(1, 9)));
        delivered.heard_over_network(source(1, 2));
        assert!(!delivered.may_be_filled(source(1, 9)), "it is still behind");
        delivered.heard_over_network(source(1, 3));
        assert!(delivered.may_be_filled(source(1, 9)));
    }

    #[test]
    fn writers_do_not_share_counts() {
        let mut delivered = Delivered::default();
        assert!(delivered.accept(source(1, 100)));
        assert!(delivered.accept(source(2, 1)), "a restarted writer has a new identity and counts from 1");
    }

    #[test]
    fn memory_is_bounded_and_the_newest_are_kept() {
        let mut delivered = Delivered::default();
        for writer in 0..1000_u64 {
            let mut gid = [0; 16];
            gid[..8].copy_from_slice(&writer.to_le_bytes());
            assert!(delivered.accept(Source { gid, sequence: 3 }));
            assert!(!delivered.is_new(Source { gid, sequence: 3 }));
        }
        assert_eq!(delivered.writers.len(), REMEMBERED);
    }
}
