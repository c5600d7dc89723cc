//! Who passes a packet on to those who do not hear its sender.

/// Robots that one packet can name to pass it on.
pub const MAX_RELAYS: usize = 3;

/// From one relay of a list to the next, ns: they speak one after the other.
pub const RELAY_SLOT: u64 = 6_000_000;

/// The robots that pass a packet on, in the order in which they speak. Each does so once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RelayList {
    ids: [u8; MAX_RELAYS],
    count: u8,
}

impl RelayList {
    /// Takes the first [`MAX_RELAYS`] ids; their five lowest bits count.
    #[must_use]
    pub fn new(robots: &[u8]) -> Self {
        let count = robots.len().min(MAX_RELAYS);
        let mut ids = [0; MAX_RELAYS];
        for (id, robot) in ids.iter_mut().zip(robots) {
            *id = robot & 0x1f;
        }
        Self { ids, count: count as u8 }
    }

    /// The ids.
    #[must_use]
    pub fn as_slice(&self) -> &[u8] {
        &self.ids[..usize::from(self.count)]
    }

    /// Whether nobody is named.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The place of a robot in the list, from 0.
    #[must_use]
    pub fn place(&self, robot: u8) -> Option<usize> {
        self.as_slice().iter().position(|id| *id == robot)
    }

    /// Five bits an id, the first lowest.
    pub(crate) fn to_bits(self) -> u16 {
        let ids = self.as_slice().iter().enumerate();
        ids.map(|(place, id)| u16::from(*id) << (5 * place)).sum()
    }

    /// Reads what [`RelayList::to_bits`] makes.
    pub(crate) fn from_bits(bits: u16, count: u8) -> Self {
        let ids: [u8; MAX_RELAYS] = std::array::from_fn(|place| (bits >> (5 * place)) as u8 & 0x1f);
        Self::new(&ids[..usize::from(count).min(MAX_RELAYS)])
    }
}

/// Whether and by whom a packet is passed on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Relaying {
    /// By nobody.
    #[default]
    Direct,
    /// From the base: by these robots, a list that is not empty.
    By(RelayList),
    /// From a robot: by whoever is a relay now, up to so many times, 1 to [`MAX_RELAYS`].
    Anyone(u8),
}

impl Relaying {
    /// By these robots, or by nobody.
    #[must_use]
    pub fn by(list: RelayList) -> Self {
        if list.is_empty() { Self::Direct } else { Self::By(list) }
    }

    /// How often the packet may be passed on.
    #[must_use]
    pub fn limit(&self) -> u8 {
        match self {
            Self::Direct => 0,
            Self::By(list) => list.count,
            Self::Anyone(limit) => (*limit).clamp(1, MAX_RELAYS as u8),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn lists_survive_their_bits(ids in proptest::collection::vec(0..32u8, 0..5)) {
            let list = RelayList::new(&ids);
            prop_assert_eq!(RelayList::from_bits(list.to_bits(), list.as_slice().len() as u8), list);
            prop_assert_eq!(list.as_slice(), &ids[..ids.len().min(MAX_RELAYS)]);
        }
    }
}
