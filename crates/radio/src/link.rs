//! What host and base station tell each other over the serial line.

use crate::{LinkError, VERSION, framing};

/// What the base station did with a packet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AckStatus {
    /// It is on the air.
    Sent,
    /// It was not a packet.
    Refused,
    /// Its validity ended while it waited.
    Expired,
}

/// The base station's answer to a downlink frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ack {
    /// The packet's counter; 0 if it was refused.
    pub counter: u64,
    /// What became of it.
    pub status: AckStatus,
    /// How long it waited for the air, in ms; 255: that or longer.
    pub wait_ms: u8,
}

/// A frame of the serial line. The packets inside are [`crate::Packet`]s, left unread: the base station has no key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinkFrame<'a> {
    /// Host to base: send this packet to all robots.
    Downlink {
        /// Goes over the air as it is.
        packet: &'a [u8],
    },
    /// Base to host: this packet came from a robot.
    Uplink {
        /// Strength in dBm at which the base heard it.
        signal_dbm: i8,
        /// How long the base kept it before this frame's first byte, in ms; 255: that or longer.
        wait_ms: u8,
        /// As it came over the air.
        packet: &'a [u8],
    },
    /// Base to host: what became of a downlink packet.
    Ack(Ack),
}

impl<'a> LinkFrame<'a> {
    /// Appends the frame to `out` as it goes over the line, delimiter included.
    pub fn encode(&self, out: &mut Vec<u8>) {
        let mut body = [0; framing::MAX_BODY];
        let (head, packet): (&[u8], &[u8]) = match self {
            Self::Downlink { packet } => (&[VERSION << 4], packet),
            Self::Uplink { signal_dbm, wait_ms, packet } => (&[VERSION << 4 | 1, *signal_dbm as u8, *wait_ms], packet),
            Self::Ack(ack) => {
                let [c0, c1, c2, c3, c4, c5, ..] = ack.counter.to_le_bytes();
                (&[VERSION << 4 | 2, c0, c1, c2, c3, c4, c5, ack.status as u8, ack.wait_ms], &[])
            }
        };
        let length = head.len() + packet.len();
        if let Some(body) = body.get_mut(..length) {
            body[..head.len()].copy_from_slice(head);
            body[head.len()..].copy_from_slice(packet);
            framing::frame(body, out);
        }
    }

    /// Reads the body of a frame.
    ///
    /// # Errors
    /// When it is too short or of an unknown version or kind.
    pub fn decode(body: &'a [u8]) -> Result<Self, LinkError> {
        let short = LinkError::Short(body.len());
        let (&version_and_kind, content) = body.split_first().ok_or(short)?;
        if version_and_kind >> 4 != VERSION {
            return Err(LinkError::Version(version_and_kind >> 4));
        }
        match version_and_kind & 0x0f {
            0 => Ok(Self::Downlink { packet: content }),
            1 => match content {
                [signal, wait_ms, packet @ ..] => {
                    Ok(Self::Uplink { signal_dbm: *signal as i8, wait_ms: *wait_ms, packet })
                }
                _ => Err(short),
            },
            2 => match *content {
                [c0, c1, c2, c3, c4, c5, status, wait_ms] => Ok(Self::Ack(Ack {
                    counter: u64::from_le_bytes([c0, c1, c2, c3, c4, c5, 0, 0]),
                    status: match status {
                        0 => AckStatus::Sent,
                        1 => AckStatus::Refused,
                        _ => AckStatus::Expired,
                    },
                    wait_ms,
                })),
                _ => Err(short),
            },
            kind => Err(LinkError::Kind(kind)),
        }
    }
}
