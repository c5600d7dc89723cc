//! The base's answer to robots that were switched on anew.

use crate::{MAX_ROBOTS, PacketError};

/// Robots that one packet can welcome: more would keep commands waiting.
pub const MAX_WELCOMED: usize = 4;

/// Id and nonce.
const ENTRY: usize = 9;

/// Robots by id, each with the nonce that its last hello named. What the counter of the packet is, is new to them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Welcome {
    entries: [(u8, u64); MAX_WELCOMED],
    count: u8,
}

impl Welcome {
    /// Takes the first [`MAX_WELCOMED`] pairs of id and nonce.
    #[must_use]
    pub fn new(robots: &[(u8, u64)]) -> Self {
        let count = robots.len().min(MAX_WELCOMED);
        let mut entries = [(0, 0); MAX_WELCOMED];
        entries[..count].copy_from_slice(&robots[..count]);
        Self { entries, count: count as u8 }
    }

    /// Ids and nonces.
    #[must_use]
    pub fn as_slice(&self) -> &[(u8, u64)] {
        &self.entries[..usize::from(self.count)]
    }

    /// The nonce that it answers to `robot`, if it names the robot.
    #[must_use]
    pub fn nonce(&self, robot: u8) -> Option<u64> {
        self.as_slice().iter().find(|(id, _)| *id == robot).map(|(_, nonce)| *nonce)
    }

    pub(crate) fn encode(&self, out: &mut Vec<u8>) {
        for (robot, nonce) in self.as_slice() {
            out.push(*robot);
            out.extend(nonce.to_le_bytes());
        }
    }

    pub(crate) fn decode(bytes: &[u8]) -> Result<Self, PacketError> {
        let (entries, rest) = bytes.as_chunks::<ENTRY>();
        if !rest.is_empty() || entries.is_empty() || entries.len() > MAX_WELCOMED {
            return Err(PacketError::Length(bytes.len()));
        }
        let mut robots = [(0, 0); MAX_WELCOMED];
        for (robot, [id, nonce @ ..]) in robots.iter_mut().zip(entries) {
            if usize::from(*id) >= MAX_ROBOTS {
                return Err(PacketError::Robot(*id));
            }
            *robot = (*id, u64::from_le_bytes(*nonce));
        }
        Ok(Self::new(&robots[..entries.len()]))
    }
}
