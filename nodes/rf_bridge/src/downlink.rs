//! Packets to the robots: counters that never go back, and a line that is never filled ahead.

use std::collections::VecDeque;
use trench_core::{RosTime, Sink, Steady, Times};
use trench_radio::framing::DELIMITER;
use trench_radio::{COUNTER_LIMIT, COUNTER_TICK, Key, LinkFrame, Packet, Payload, Relaying};

/// The one byte stream of the bridge.
pub(crate) const STREAM: usize = 0;

/// Counters are promised in blocks of a minute: a checkpoint so often.
const BLOCK: u64 = 1 << 16;

/// Packets whose time of sending is remembered.
const REMEMBERED: usize = 128;

/// A packet that was sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Sent {
    /// The lowest 16 bits of its counter.
    counter: u16,
    /// When.
    pub(crate) at: Steady,
    /// Packets before it.
    pub(crate) before: u64,
}

#[cfg(test)]
impl Sent {
    pub(crate) fn of_test(at: Steady, before: u64) -> Self {
        Self { counter: 0, at, before }
    }
}

/// The way down.
#[derive(Debug, Clone)]
pub(crate) struct Downlink {
    key: Option<Key>,
    byte_time: f64,
    counter: u64,
    /// The counter of the monotonic clock's zero.
    origin: u64,
    promised: u64,
    free_at: Steady,
    packets: u64,
    sent: VecDeque<Sent>,
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
            origin: promised,
            promised,
            free_at: Steady::default(),
            packets: 0,
            sent: VecDeque::with_capacity(REMEMBERED),
            packet: Vec::new(),
            line: Vec::new(),
        }
    }

    /// Starts at a counter that is beyond those of earlier lives even if they left nothing: that of this host's `wall` clock, since
    /// ROS time may be another host's, or a simulation's, and still be zero. From there on counters follow the monotonic clock, so
    /// that robots can tell by them how old a packet is.
    pub(crate) fn start(&mut self, at: Times, wall: RosTime) {
        let by_clock = at.ros.0.max(wall.0).max(0).unsigned_abs() / COUNTER_TICK;
        self.counter = self.counter.max(by_clock % COUNTER_LIMIT);
        self.origin = self.counter.saturating_sub(at.steady.0 / COUNTER_TICK);
    }

    /// The counter of a packet sent now. It may be ahead of the clock where packets follow each other closely.
    fn next_counter(&self, now: Steady) -> u64 {
        (self.counter + 1).max(self.origin + now.0 / COUNTER_TICK)
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

    /// The packet whose counter ends with these 16 bits.
    pub(crate) fn sent(&self, counter: u16) -> Option<Sent> {
        self.sent.iter().rev().find(|sent| sent.counter == counter).copied()
    }

    /// The first counter that no packet of this life carries, for the checkpoint.
    pub(crate) fn promised(&self) -> u64 {
        self.promised
    }

    /// Moves the promise on if the next packet would break it: then a checkpoint is due, before the packet goes out.
    pub(crate) fn extend_promise(&mut self, now: Steady) -> bool {
        let next = self.next_counter(now);
        let due = next >= self.promised;
        if due {
            self.promised = next + BLOCK;
        }
        due
    }

    /// Sends a packet.
    pub(crate) fn send(&mut self, now: Steady, relaying: Relaying, payload: Payload, sink: &mut dyn Sink) {
        self.counter = self.next_counter(now);
        self.packet.clear();
        self.line.clear();
        Packet { relayed: 0, relaying, counter: self.counter, payload }.encode(self.key.as_ref(), &mut self.packet);
        // A delimiter first: garbage that the base station may have heard does not spoil this frame.
        self.line.push(DELIMITER);
        LinkFrame::Downlink { packet: &self.packet }.encode(&mut self.line);
        sink.write_bytes(STREAM, &self.line);
        self.free_at = self.free_at.max(now).plus_seconds(self.byte_time * self.line.len() as f64);
        if self.sent.len() == REMEMBERED {
            self.sent.pop_front();
        }
        self.sent.push_back(Sent { counter: self.counter as u16, at: now, before: self.packets });
        self.packets += 1;
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
        let lives = [(0, 0, 0), (1 << 40, 0, 7_000_000_000), (0, 0, 1 << 50), (-5, 0, 3), (0, 1 << 60, 3)];
        for (clock, wall, at_start) in lives {
            let clock = RosTime(clock);
            let mut outbox = Outbox::default();
            let mut downlink = Downlink::new(None, 115_200, promised);
            downlink.start(Times { ros: clock, steady: Steady(at_start) }, RosTime(wall));
            for at in 0..5000 {
                let now = Steady(at_start + at * 20_000_000);
                if downlink.extend_promise(now) {
                    promised = downlink.promised();
                }
                downlink.send(now, Relaying::Direct, Payload::Reset(RobotSet::ALL), &mut outbox);
            }
            let counters = counters(&outbox);
            assert_eq!(counters.len(), 5000);
            assert!(counters[0] >= wall.unsigned_abs() / COUNTER_TICK, "whatever ROS time is");
            assert!(counters[0] > highest && counters.is_sorted_by(|earlier, later| earlier < later));
            // Counters tell the time: 4999 intervals of 20 ms.
            assert!((counters[4999] - counters[0]).abs_diff(4999 * 20_000_000 / COUNTER_TICK) <= 1);
            highest = counters[4999];
            assert!(highest < promised, "what was promised covers what was sent");
        }
    }

    #[test]
    fn the_line_is_free_when_its_bytes_are_through() {
        let mut downlink = Downlink::new(None, 115_200, 0);
        downlink.send(Steady(5_000_000), Relaying::Direct, Payload::Reset(RobotSet::ALL), &mut Outbox::default());
        let expected = 5_000_000 + 18 * 86_805;
        assert!(downlink.free_at().0.abs_diff(expected) < 100, "{:?}", downlink.free_at());
    }
}
