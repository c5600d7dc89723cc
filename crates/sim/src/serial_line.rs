//! A serial line: every byte takes its time.

use std::collections::VecDeque;
use trench_radio::framing::{DELIMITER, MAX_STUFFED};

/// One direction of a line. Bytes come out in runs that end with a delimiter, when their last byte has arrived: what
/// lies between cannot be acted on by any receiver.
#[derive(Debug, Clone)]
pub struct SerialLine {
    byte_time: u64,
    free_at: u64,
    begun: Vec<u8>,
    runs: VecDeque<(u64, Vec<u8>)>,
}

impl SerialLine {
    /// A line of so many bits per second, ten to a byte.
    #[must_use]
    pub fn new(baud: u32) -> Self {
        let byte_time = 10_000_000_000 / u64::from(baud.max(1));
        Self { byte_time, free_at: 0, begun: Vec::new(), runs: VecDeque::new() }
    }

    /// Puts bytes into the line at a time (ns) that is not before that of the last call.
    pub fn write(&mut self, now: u64, bytes: &[u8]) {
        self.free_at = self.free_at.max(now);
        for &byte in bytes {
            self.free_at += self.byte_time;
            self.begun.push(byte);
            if byte == DELIMITER || self.begun.len() > MAX_STUFFED {
                self.runs.push_back((self.free_at, std::mem::take(&mut self.begun)));
            }
        }
    }

    /// When the next run is through, if one is on its way.
    #[must_use]
    pub fn next_arrival(&self) -> Option<u64> {
        self.runs.front().map(|(at, _)| *at)
    }

    /// Takes the next run with the time of its arrival.
    pub fn read(&mut self) -> Option<(u64, Vec<u8>)> {
        self.runs.pop_front()
    }

    /// For how long the line is still busy with what was written, ns.
    #[must_use]
    pub fn backlog(&self, now: u64) -> u64 {
        self.free_at.saturating_sub(now)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_byte_takes_87_microseconds() {
        let mut line = SerialLine::new(115_200);
        line.write(1_000_000, &[1, 2, 0, 3]);
        line.write(1_100_000, &[4, 0]);
        line.write(9_000_000, &[0]);
        assert_eq!(line.read(), Some((1_000_000 + 3 * 86_805, vec![1, 2, 0])));
        assert_eq!(line.read(), Some((1_000_000 + 6 * 86_805, vec![3, 4, 0])));
        assert_eq!(line.read(), Some((9_086_805, vec![0])));
        assert_eq!(line.read(), None);
    }

    #[test]
    fn garbage_without_delimiters_comes_out_too() {
        let mut line = SerialLine::new(115_200);
        line.write(0, &[7; 1000]);
        let lengths: Vec<usize> = std::iter::from_fn(|| line.read()).map(|(_, run)| run.len()).collect();
        assert_eq!(lengths, [MAX_STUFFED + 1; 3]);
    }
}
