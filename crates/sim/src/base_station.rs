//! The radio base station: frames of the serial line become packets on the air and the other way round.

use std::collections::VecDeque;
use trench_radio::{Ack, AckStatus, LinkFrame, StreamDecoder, VERSION};

/// Reports from robots are dropped while the line to the host is busy for longer than this, ns: old news would only
/// make the news that follow older.
const LONGEST_BACKLOG: u64 = 50_000_000;

/// Bytes of a packet's header.
const HEADER_LENGTH: usize = 8;

/// Reports that are remembered, to pass those that come again over relays on once.
const REMEMBERED: usize = 64;

/// The base station's state.
#[derive(Debug, Clone, Default)]
pub struct BaseStation {
    decoder: StreamDecoder,
    passed_on: VecDeque<Box<[u8]>>,
}

impl BaseStation {
    /// Takes bytes from the host. Packets for the air go to `broadcast`, what the host is told to `reply` (frames for
    /// the line).
    pub fn from_host(&mut self, bytes: &[u8], mut broadcast: impl FnMut(&[u8]), reply: &mut Vec<u8>) {
        self.decoder.push(bytes, |frame| {
            let LinkFrame::Downlink { packet } = frame else { return };
            let ack = match packet {
                [first, _, c0, c1, c2, c3, c4, c5, ..] if first >> 4 == VERSION && packet.len() > HEADER_LENGTH => {
                    broadcast(packet);
                    let counter = u64::from_le_bytes([*c0, *c1, *c2, *c3, *c4, *c5, 0, 0]);
                    Ack { counter, status: AckStatus::Sent, wait_ms: 0 }
                }
                _ => Ack { counter: 0, status: AckStatus::Refused, wait_ms: 0 },
            };
            LinkFrame::Ack(ack).encode(reply);
        });
    }

    /// The line to the host, after the packet of a robot was heard.
    pub fn from_robot(&mut self, packet: &[u8], signal_dbm: i8, backlog: u64, line: &mut Vec<u8>) {
        // Copies differ in how often they were relayed, which the second byte's upper half counts.
        let essence = |bytes: &[u8]| -> Box<[u8]> {
            let mut bytes: Box<[u8]> = bytes.into();
            if let Some(flags) = bytes.get_mut(1) {
                *flags &= 0x0f;
            }
            bytes
        };
        let essence = essence(packet);
        if backlog > LONGEST_BACKLOG || self.passed_on.contains(&essence) {
            return;
        }
        if self.passed_on.len() == REMEMBERED {
            self.passed_on.pop_front();
        }
        self.passed_on.push_back(essence);
        let wait_ms = u8::try_from(backlog / 1_000_000).unwrap_or(u8::MAX);
        LinkFrame::Uplink { signal_dbm, wait_ms, packet }.encode(line);
    }

    /// The host's bytes as they were understood.
    #[must_use]
    pub fn decoder(&self) -> &StreamDecoder {
        &self.decoder
    }
}
