//! Copies for the network of what all readers should get through shared memory, kept for a moment.

use rustdds::bytes::Bytes;
use std::collections::VecDeque;
use trench_core::Steady;

/// How long a copy is kept, s: as long as a reader waits for the network to fill a gap.
const KEPT_SECONDS: f64 = 0.3;

/// The last messages with their counts, in order.
#[derive(Debug)]
pub(super) struct Held {
    copies: VecDeque<(u64, Bytes, Steady)>,
    /// As many as a reader's shared memory surely still holds.
    capacity: usize,
}

impl Held {
    /// Keeps up to `capacity` messages.
    pub(super) fn new(capacity: usize) -> Self {
        Self { copies: VecDeque::new(), capacity }
    }

    /// Keeps a message. True when they come faster than a busy reader's shared memory may hold them: then the network
    /// must bring what is kept.
    pub(super) fn keep(&mut self, count: u64, message: Bytes, now: Steady) -> bool {
        self.copies.push_back((count, message, now));
        self.expire(now);
        self.copies.len() > self.capacity
    }

    /// Gives what is kept to the network.
    pub(super) fn release(&mut self, now: Steady) -> impl Iterator<Item = (u64, Bytes)> {
        self.expire(now);
        std::mem::take(&mut self.copies).into_iter().map(|(count, message, _)| (count, message))
    }

    /// Forgets what is kept.
    pub(super) fn clear(&mut self) {
        self.copies.clear();
    }

    fn expire(&mut self, now: Steady) {
        while self.copies.front().is_some_and(|(_, _, at)| now.seconds_since(*at) > KEPT_SECONDS) {
            self.copies.pop_front();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(milliseconds: u64) -> Steady {
        Steady(milliseconds * 1_000_000)
    }

    /// Keeps `messages` at these times; gives whether any of them was one too many.
    fn keep(held: &mut Held, milliseconds: impl Iterator<Item = u64>) -> bool {
        let mut count = 0;
        milliseconds.fold(false, |burst, time| {
            count += 1;
            held.keep(count, Bytes::from(vec![0]), at(time)) || burst
        })
    }

    #[test]
    fn a_burst_wants_the_network_and_a_steady_stream_does_not() {
        assert!(!keep(&mut Held::new(4), (0..50).map(|number| number * 100)));
        assert!(keep(&mut Held::new(4), (0..5).map(|number| number * 60)));
    }

    #[test]
    fn what_is_released_is_young_and_in_order() {
        let mut held = Held::new(10);
        assert!(!keep(&mut held, [0, 150, 200, 390].into_iter()));
        let counts: Vec<u64> = held.release(at(400)).map(|(count, _)| count).collect();
        assert_eq!(counts, [2, 3, 4]);
        assert_eq!(held.release(at(400)).count(), 0);
    }
}
