//! Packets to the robots: counters that never go back, and a line that is never filled ahead.

use std::collections::VecDeque;
use trench_core::{RosTime, Sink, Steady};
use trench_radio::framing::DELIMITER;
use trench_radio::{COUNTER_LIMIT, Key, LinkFrame, Packet, Payload};

/// The one byte stream of the bridge.
pub(crate) const STREAM: usize = 0;

/// Counters are promised in blocks: a checkpoint every so many packets.
const BLOCK: u64 = 4096;

/// Packets whose time of sending is remembered.
const REMEMBERED: usize = 128;

/// The way down.
#[derive(Debug, Clone)]
pub(crate) struct Downlink {
    key: Option<Key>,
    byte_time: f64,
    counter: u64,
    promised: u64,
    free_at: Steady,
    sent: VecDeque<(u16, Steady)>,
    packet: Vec<u8>,
    line: Vec<u8>,
}

impl Downlink {
    /// Continues behind `promised`, the counter that an earlier life has left.
    pub(crate) fn new(key: Option<Key>, baud: u32, promised: u64) -> Self {
        Self {
            key,
            byte_time: 10.0 / f64::from(baud.max(1)),
            counter: promised,
            promised,
            free_at: Steady::default(),
            sent: VecDeque::with_capacity(REMEMBERED),
            packet: Vec::new(),
            line: Vec::new(),
        }
    }

    /// Starts at a counter that is beyond those of earlier lives even if they left nothing: milliseconds (nearly) of
    /// the clock, of which far less than one is used a millisecond.
    pub(crate) fn start(&mut self, ros: RosTime) {
        let by_clock = ros.0.max(0).unsigned_abs() >> 20;
        self.counter = self.counter.max(by_clock % COUNTER_LIMIT);
    }

    /// The key, for the way up.
    pub(crate) fn key(&self) -> Option<&Key> {
        self.key.as_ref()
    }

    /// When all bytes written so far are through.
    pub(crate) fn free_at(&self) -> Steady {
        self.free_at
    }

    /// How long a commands frame for so many robots keeps the line busy, s.
    pub(crate) fn duration(&self, robots: usize) -> f64 {
        let tag = if self.key.is_some() { 8 } else { 0 };
        self.byte_time * (19 + 4 * robots + robots.div_ceil(4) + tag) as f64
    }

    /// When the packet was sent whose counter ends with these 16 bits.
    pub(crate) fn sent_at(&self, counter: u16) -> Option<Steady> {
        self.sent.iter().rev().find(|(sent, _)| *sent == counter).map(|(_, at)| *at)
    }

    /// The first counter that no packet of this life carries, for the checkpoint.
    pub(crate) fn promised(&self) -> u64 {
        self.promised
    }

    /// Moves the promise on if the next packet would break it: then a checkpoint is due, before the packet goes out.
    pub(crate) fn extend_promise(&mut self) -> bool {
        let due = self.counter + 1 >= self.promised;
        if due {
            self.promised = self.counter + 1 + BLOCK;
        }
        due
    }

    /// Sends a packet.
    pub(crate) fn send(&mut self, now: Steady, payload: Payload, sink: &mut dyn Sink) {
        self.counter += 1;
        self.packet.clear();
        self.line.clear();
        Packet { relayed: 0, counter: self.counter, payload }.encode(self.key.as_ref(), &mut self.packet);
        // A delimiter first: garbage that the base station may have heard does not spoil this frame.
        self.line.push(DELIMITER);
        LinkFrame::Downlink { packet: &self.packet }.encode(&mut self.line);
        sink.write_bytes(STREAM, &self.line);
        self.free_at = self.free_at.max(now).plus_seconds(self.byte_time * self.line.len() as f64);
        if self.sent.len() == REMEMBERED {
            self.sent.pop_front();
        }
        self.sent.push_back((self.counter as u16, now));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_core::{Action, Outbox};
    use trench_radio::{RobotSet, StreamDecoder};

    /// The counters of the packets that were written.
    fn counters(outbox: &Outbox) -> Vec<u64> {
        let (mut counters, mut decoder) = (Vec::new(), StreamDecoder::default());
        for action in &outbox.actions {
            let Action::Write { bytes, .. } = action else { continue };
            decoder.push(bytes, |frame| {
                if let LinkFrame::Downlink { packet } = frame {
                    counters.extend(Packet::decode(packet, None).map(|packet| packet.counter));
                }
            });
        }
        counters
    }

    #[test]
    fn counters_go_up_across_lives_whatever_the_clock_says() {
        let (mut promised, mut highest) = (0, 0);
        for clock in [RosTime(0), RosTime(1 << 40), RosTime(0), RosTime(-5)] {
            let mut outbox = Outbox::default();
            let mut downlink = Downlink::new(None, 115_200, promised);
            downlink.start(clock);
            for at in 0..5000 {
                if downlink.extend_promise() {
                    promised = downlink.promised();
                }
                downlink.send(Steady(at * 1_000_000), Payload::Reset(RobotSet::ALL), &mut outbox);
            }
            let counters = counters(&outbox);
            assert_eq!(counters.len(), 5000);
            assert!(counters[0] > highest && counters.windows(2).all(|pair| pair[1] == pair[0] + 1));
            highest = counters[4999];
            assert!(highest < promised, "what was promised covers what was sent");
        }
    }

    #[test]
    fn the_line_is_free_when_its_bytes_are_through() {
        let mut downlink = Downlink::new(None, 115_200, 0);
        downlink.send(Steady(5_000_000), Payload::Reset(RobotSet::ALL), &mut Outbox::default());
        let expected = 5_000_000 + 18 * 86_805;
        assert!(downlink.free_at().0.abs_diff(expected) < 100, "{:?}", downlink.free_at());
    }
}
