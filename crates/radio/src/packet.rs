//! What goes over the air: header, payload, authentication tag.

use crate::key::TAG_LENGTH;
use crate::{Commands, Key, MAX_RELAYS, PacketError, RelayList, Relaying, RobotSet, Telemetry, Welcome};

/// The version of the protocol.
pub const VERSION: u8 = 3;

/// Counters are below this: they have 48 bits.
pub const COUNTER_LIMIT: u64 = 1 << 48;

/// Version and kind, flags, counter.
const HEADER_LENGTH: usize = 8;

/// Flag: a tag follows the payload.
const FLAG_TAG: u8 = 1;

/// Flags: how often the packet may be relayed.
const FLAGS_LIMIT: u8 = 0b1110;

/// The kinds of packets that robots send; all others come from the base.
const TELEMETRY: u8 = 3;
const HELLO: u8 = 4;

const WELCOME: u8 = 5;

/// Bytes of a nonce.
const NONCE_LENGTH: usize = 8;

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
    /// Robot with a key to base, in place of [`Payload::Telemetry`] until it is welcomed: it was switched on and knows no
    /// counter of the base.
    Hello {
        /// A number that nobody could know before; each hello has its own.
        nonce: u64,
        /// What it reports.
        report: Telemetry,
    },
    /// Base to robots that said hello.
    Welcome(Welcome),
}

impl Payload {
    /// What a robot reports, if a robot sends it.
    #[must_use]
    pub fn report(&self) -> Option<&Telemetry> {
        match self {
            Self::Telemetry(report) | Self::Hello { report, .. } => Some(report),
            Self::Commands(_) | Self::EmergencyStop(_) | Self::Reset(_) | Self::Welcome(_) => None,
        }
    }
}

/// A packet over the air.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Packet {
    /// How often it was relayed, 0 to 15. The one field a relay may change, so the tag does not cover it.
    pub relayed: u8,
    /// Who passes it on.
    pub relaying: Relaying,
    /// Never goes back, 48 bits. The base's follow its clock in steps of [`crate::COUNTER_TICK`].
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
            Payload::Telemetry(_) => TELEMETRY,
            Payload::Hello { .. } => HELLO,
            Payload::Welcome(_) => WELCOME,
        };
        let tag_flag = if key.is_some() { FLAG_TAG } else { 0 };
        out.extend([VERSION << 4 | kind, tag_flag | self.relaying.limit() << 1]);
        out.extend_from_slice(&self.counter.to_le_bytes()[..6]);
        if let Relaying::By(list) = self.relaying {
            out.extend(list.to_bits().to_le_bytes());
        }
        match &self.payload {
            Payload::Commands(commands) => commands.encode(out),
            Payload::EmergencyStop(robots) | Payload::Reset(robots) => out.extend(robots.0.to_le_bytes()),
            Payload::Telemetry(telemetry) => telemetry.encode(out),
            Payload::Hello { nonce, report } => {
                out.extend(nonce.to_le_bytes());
                report.encode(out);
            }
            Payload::Welcome(welcome) => welcome.encode(out),
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
        let kind = version_and_kind & 0x0f;
        let (relaying, payload) = decode_relaying(kind, (flags & FLAGS_LIMIT) >> 1, payload)?;
        Ok(Self {
            relayed: flags >> 4,
            relaying,
            counter: u64::from_le_bytes([c0, c1, c2, c3, c4, c5, 0, 0]),
            payload: decode_payload(kind, payload)?,
        })
    }
}

/// The packet's bytes as a relay sends them on.
#[must_use]
pub fn relayed_once_more(packet: &[u8]) -> Vec<u8> {
    let mut packet = packet.to_vec();
    if let Some(flags) = packet.get_mut(1) {
        *flags = *flags & 0x0f | (*flags >> 4).saturating_add(1).min(15) << 4;
    }
    packet
}

/// Who passes a packet on, and what follows.
fn decode_relaying(kind: u8, limit: u8, rest: &[u8]) -> Result<(Relaying, &[u8]), PacketError> {
    if usize::from(limit) > MAX_RELAYS {
        return Err(PacketError::Relays(limit));
    }
    match (limit, kind) {
        (0, _) => Ok((Relaying::Direct, rest)),
        (_, TELEMETRY | HELLO) => Ok((Relaying::Anyone(limit), rest)),
        _ => {
            let (bits, rest) = rest.split_first_chunk::<2>().ok_or(PacketError::Length(rest.len()))?;
            Ok((Relaying::By(RelayList::from_bits(u16::from_le_bytes(*bits), limit)), rest))
        }
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
        TELEMETRY => Telemetry::decode(bytes).map(Payload::Telemetry),
        HELLO => {
            let (nonce, report) = bytes.split_first_chunk::<NONCE_LENGTH>().ok_or(PacketError::Length(bytes.len()))?;
            let nonce = u64::from_le_bytes(*nonce);
            Telemetry::decode(report).map(|report| Payload::Hello { nonce, report })
        }
        WELCOME => Welcome::decode(bytes).map(Payload::Welcome),
        _ => Err(PacketError::Kind(kind)),
    }
}
