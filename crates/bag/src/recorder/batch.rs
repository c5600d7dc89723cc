//! Messages that were heard and are not in the bag yet.

use std::ops::Range;

/// What was heard since the last time that anything was written, so that the recorder need not wake for every message.
#[derive(Debug, Default)]
pub(super) struct Batch {
    messages: Vec<Heard>,
    /// All messages, one behind the other.
    bytes: Vec<u8>,
}

/// One of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Heard {
    /// Index of the subscription.
    pub(super) port: usize,
    /// When it was written or came, ROS time, ns.
    pub(super) time: u64,
    /// Its writer's count.
    pub(super) sequence: u32,
    bytes: Range<usize>,
}

impl Batch {
    /// Keeps a message.
    pub(super) fn keep(&mut self, port: usize, time: u64, sequence: u32, message: &[u8]) {
        let start = self.bytes.len();
        self.bytes.extend_from_slice(message);
        self.messages.push(Heard { port, time, sequence, bytes: start..self.bytes.len() });
    }

    /// Gives all messages to `write` in the order of their times, those of one time as they were heard, and forgets them.
    pub(super) fn write<E>(&mut self, mut write: impl FnMut(&Heard, &[u8]) -> Result<(), E>) -> Result<(), E> {
        self.messages.sort_by_key(|heard| heard.time);
        let done = self.messages.iter().try_for_each(|heard| write(heard, &self.bytes[heard.bytes.clone()]));
        self.messages.clear();
        self.bytes.clear();
        done
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_come_out_once_and_in_the_order_of_their_times() {
        let mut batch = Batch::default();
        for (port, time, text) in [(0, 30, "c"), (1, 10, "long"), (2, 30, ""), (0, 20, "b")] {
            batch.keep(port, time, 7, text.as_bytes());
        }
        let mut written = Vec::new();
        let mut note = |heard: &Heard, message: &[u8]| {
            written.push((heard.port, heard.time, heard.sequence, message.to_vec()));
            Ok::<(), ()>(())
        };
        batch.write(&mut note).unwrap();
        batch.write(&mut note).unwrap();
        let expected = [(1, 10, 7, &b"long"[..]), (0, 20, 7, b"b"), (0, 30, 7, b"c"), (2, 30, 7, b"")];
        assert_eq!(written, expected.map(|(port, time, sequence, text)| (port, time, sequence, text.to_vec())));
    }

    #[test]
    fn nothing_is_written_after_an_error() {
        let mut batch = Batch::default();
        batch.keep(0, 1, 1, b"one");
        batch.keep(0, 2, 2, b"two");
        let mut times = Vec::new();
        let full = batch.write(|heard, _| {
            times.push(heard.time);
            Err("the disk is full")
        });
        assert_eq!((full, times), (Err("the disk is full"), vec![1]));
    }
}
