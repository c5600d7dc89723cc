//! What can be wrong with bytes from a serial line or the air, and how often it was.

use std::collections::BTreeMap;

/// Why bytes between two delimiters are not a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LinkError {
    /// More bytes than any frame has.
    #[error("more than {} bytes without a delimiter", crate::framing::MAX_STUFFED)]
    Overlong,
    /// The byte stuffing points beyond the end.
    #[error("the byte stuffing is broken")]
    Stuffing,
    /// Too few bytes for a frame of this kind.
    #[error("a frame of {0} bytes is too short")]
    Short(usize),
    /// The checksum does not match.
    #[error("the checksum is {found:#06x}, the bytes give {computed:#06x}")]
    Checksum {
        /// What the frame says.
        found: u16,
        /// What its bytes give.
        computed: u16,
    },
    /// A frame of another protocol version.
    #[error("version {0}, this is version {here}", here = crate::VERSION)]
    Version(u8),
    /// A kind of frame that this version does not have.
    #[error("unknown kind of frame {0}")]
    Kind(u8),
}

/// Why the bytes of a frame are not a packet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum PacketError {
    /// The bytes end before the packet does, or go on after it.
    #[error("a packet of {0} bytes has the wrong length for its kind")]
    Length(usize),
    /// A packet of another protocol version.
    #[error("version {0}, this is version {here}", here = crate::VERSION)]
    Version(u8),
    /// A kind of packet that this version does not have.
    #[error("unknown kind of packet {0}")]
    Kind(u8),
    /// A timer value that asks for more than the fastest speed.
    #[error("timer value {0} is faster than {limit}", limit = crate::TIMER_FASTEST)]
    Timer(u16),
    /// The packet names a robot beyond the last.
    #[error("robot {0} is beyond {last}", last = crate::MAX_ROBOTS - 1)]
    Robot(u8),
    /// The packet may be relayed more often than it can name relays.
    #[error("{0} relays are more than {limit}", limit = crate::MAX_RELAYS)]
    Relays(u8),
    /// A key is in force, and the packet carries no tag.
    #[error("the packet is not authenticated")]
    Unauthenticated,
    /// The tag was made with another key or for other bytes.
    #[error("the authentication tag is wrong")]
    Tag,
}

impl LinkError {
    /// A word for counters and diagnostics.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Overlong => "overlong",
            Self::Stuffing => "stuffing",
            Self::Short(_) => "short",
            Self::Checksum { .. } => "checksum",
            Self::Version(_) => "version",
            Self::Kind(_) => "kind",
        }
    }
}

impl PacketError {
    /// A word for counters and diagnostics.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Length(_) => "packet_length",
            Self::Version(_) => "packet_version",
            Self::Kind(_) => "packet_kind",
            Self::Timer(_) => "packet_timer",
            Self::Robot(_) => "packet_robot",
            Self::Relays(_) => "packet_relays",
            Self::Unauthenticated => "unauthenticated",
            Self::Tag => "tag",
        }
    }
}

/// How often each kind of error was seen.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ErrorCounts(BTreeMap<&'static str, u64>);

impl ErrorCounts {
    /// Counts one error.
    pub fn count(&mut self, name: &'static str) {
        *self.0.entry(name).or_insert(0) += 1;
    }

    /// How often `name` was counted.
    #[must_use]
    pub fn get(&self, name: &str) -> u64 {
        self.0.get(name).copied().unwrap_or(0)
    }

    /// All errors together.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.0.values().sum()
    }

    /// Names and counts, ordered by name.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, u64)> {
        self.0.iter().map(|(name, count)| (*name, *count))
    }
}
