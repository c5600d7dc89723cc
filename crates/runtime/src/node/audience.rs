//! Who reads a topic, and whether all of them do so through shared memory.

use crate::transport::network::Gid;
use std::collections::BTreeSet;

/// The readers of one topic. Whoever reads shared memory says there who he is on the network.
#[derive(Debug, Default)]
pub(super) struct Audience {
    /// All readers that the network has found.
    matched: BTreeSet<Gid>,
    /// Readers of shared memory.
    served: BTreeSet<Gid>,
}

impl Audience {
    /// The network's readers are these now.
    pub(super) fn matched(&mut self, readers: BTreeSet<Gid>) {
        self.matched = readers;
    }

    /// Those of shared memory are these now.
    pub(super) fn served(&mut self, readers: BTreeSet<Gid>) {
        self.served = readers;
    }

    /// Whom only the network reaches.
    pub(super) fn beyond(&self) -> BTreeSet<Gid> {
        self.matched.difference(&self.served).copied().collect()
    }

    /// Whether shared memory reaches every reader: nobody is left whom only the network reaches.
    pub(super) fn shares_memory(&self) -> bool {
        self.matched.is_subset(&self.served)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_network_may_rest_when_nobody_needs_it() {
        let check = |matched: &[u8], served: &[u8], expected: bool| {
            let gids = |numbers: &[u8]| numbers.iter().map(|number| [*number; 16]).collect();
            let mut audience = Audience::default();
            audience.matched(gids(matched));
            audience.served(gids(served));
            assert_eq!(audience.shares_memory(), expected, "{matched:?} {served:?}");
            assert_eq!(audience.beyond().is_empty(), expected);
        };
        check(&[], &[], true);
        check(&[], &[1], true);
        check(&[1], &[], false);
        check(&[1, 2], &[2, 1], true);
        check(&[1, 2], &[2, 3], false);
    }
}
