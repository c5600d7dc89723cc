//! What goes over the air: header, payload, authentication tag.

use crate::key::TAG_LENGTH;
use crate::{Commands, Key, PacketError, RobotSet, Telemetry};

/// The version of the protocol.
pub const VERSION: u8 = 1;

/// Counters are below this: they have 48 bits.
pub const COUNTER_LIMIT: u64 = 1 << 48;

/// Version and kind, flags, counter.
const HEADER_LENGTH: usize = 8;

/// Flag: a tag follows the payload.
const FLAG_TAG: u8 = 1;

/// What a packet says.
#[expect(clippy::large_enum_variant, reason = "lives on the stack for one call; a box would allocate every cycle")]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Payload {
    /// Base to all robots: wheel timers.
    Commands(Commands),
    /// Base to these robots: stop at once and stay so until a reset.
    EmergencyStop(RobotSet),
    /// Base to these robots: an emergency stop is over.
    Reset(RobotSet),
    /// Robot to base.
    Telemetry(Telemetry),
}

/// A packet over the air.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Packet {
    /// How often it was relayed, 0 to 15. The one field a relay may change, so the tag does not cover it.
    pub relayed: u8,
    /// Counts the sender's packets and never goes back: 48 bits.
    pub counter: u64,
    /// What it says.
    pub payload: Payload,
}

impl Packet {
    /// Appends the packet's bytes to `out`, with a tag if there is a key.
    pub fn encode(&self, key: Option<&Key>, out: &mut Vec<u8>) {
        let start = out.len();
        let kind = match &self.payload {
            Payload::Commands(_) => 0,
            Payload::EmergencyStop(_) => 1,
            Payload::Reset(_) => 2,
            Payload::Telemetry(_) => 3,
        };
        out.extend([VERSION << 4 | kind, if key.is_some() { FLAG_TAG } else { 0 }]);
        out.extend_from_slice(&self.counter.to_le_bytes()[..6]);
        match &self.payload {
            Payload::Commands(commands) => commands.encode(out),
            Payload::EmergencyStop(robots) | Payload::Reset(robots) => out.extend(robots.0.to_le_bytes()),
            Payload::Telemetry(telemetry) => telemetry.encode(out),
        }
        if let Some(key) = key {
            let tag = key.tag(&out[start..], &[]);
            out.extend(tag);
        }
        out[start + 1] |= self.relayed << 4;
    }

    /// Reads a packet. With a key, only packets that carry its tag are packets; without, a tag is not looked at.
    ///
    /// # Errors
    /// What is wrong with the bytes.
    pub fn decode(bytes: &[u8], key: Option<&Key>) -> Result<Self, PacketError> {
        let (header, rest) = bytes.split_first_chunk::<HEADER_LENGTH>().ok_or(PacketError::Length(bytes.len()))?;
        let [version_and_kind, flags, counter @ ..] = *header;
        if version_and_kind >> 4 != VERSION {
            return Err(PacketError::Version(version_and_kind >> 4));
        }
        let payload = match (flags & FLAG_TAG != 0, key) {
            (false, Some(_)) => return Err(PacketError::Unauthenticated),
            (false, None) => rest,
            (true, key) => {
                let (payload, tag) = rest.split_last_chunk::<TAG_LENGTH>().ok_or(PacketError::Length(bytes.len()))?;
                let mut sealed = *header;
                sealed[1] &= 0x0f;
                if key.is_some_and(|key| key.tag(&sealed, payload) != *tag) {
                    return Err(PacketError::Tag);
                }
                payload
            }
        };
        let [c0, c1, c2, c3, c4, c5] = counter;
        Ok(Self {
            relayed: flags >> 4,
            counter: u64::from_le_bytes([c0, c1, c2, c3, c4, c5, 0, 0]),
            payload: decode_payload(version_and_kind & 0x0f, payload)?,
        })
    }
}

/// Reads the payload of a kind.
fn decode_payload(kind: u8, bytes: &[u8]) -> Result<Payload, PacketError> {
    let robots = || match bytes.try_into() {
        Ok(set) => Ok(RobotSet(u32::from_le_bytes(set))),
        Err(_) => Err(PacketError::Length(bytes.len())),
    };
    match kind {
        0 => Commands::decode(bytes).map(Payload::Commands),
        1 => robots().map(Payload::EmergencyStop),
        2 => robots().map(Payload::Reset),
        3 => Telemetry::decode(bytes).map(Payload::Telemetry),
        _ => Err(PacketError::Kind(kind)),
    }
}
