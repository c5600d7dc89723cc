//! Messages in the order of their log times.
//!
//! Recorders write chunks nearly in order, but messages may be logged out of order and chunks may overlap. Only
//! chunks that overlap are held in memory together.

use super::file::{BagFile, Block};
use super::record::{self, MessageRecord};
use crate::{BagError, BagReader};
use mcap::records::op;
use std::borrow::Borrow;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Deref;
use std::sync::Arc;

/// A message of a bag. Its bytes are those of the chunk they came in, which stays in memory as long as this does.
#[derive(Clone)]
pub struct BagMessage {
    /// Index into [`crate::BagReader::topics`].
    pub topic: usize,
    /// When the recorder got it, ns.
    pub log_time: u64,
    /// When it was published, ns.
    pub publish_time: u64,
    /// Its writer's count, 0 where the recorder did not know it.
    pub sequence: u32,
    block: Arc<Vec<u8>>,
    start: usize,
    end: usize,
}

impl Deref for BagMessage {
    type Target = [u8];

    /// The message: CDR with its encapsulation header.
    fn deref(&self) -> &[u8] {
        self.block.get(self.start..self.end).unwrap_or_default()
    }
}

/// An iterator over the messages of a bag, which it borrows or shares.
pub struct Messages<B> {
    bag: B,
    /// The number of the file that comes next.
    next_file: usize,
    current: Option<FileMessages>,
    /// Messages before this log time are left out, ns.
    from: u64,
}

impl<B: Borrow<BagReader>> Messages<B> {
    pub(super) fn new(bag: B, from: u64) -> Self {
        Self { bag, next_file: 0, current: None, from }
    }
}

impl<B: Borrow<BagReader>> Iterator for Messages<B> {
    type Item = Result<BagMessage, BagError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let files = &self.bag.borrow().files;
            let current = self.current.as_mut().zip(self.next_file.checked_sub(1).and_then(|last| files.get(last)));
            match current.and_then(|(current, file)| current.next(file)) {
                Some(Ok(message)) if message.log_time < self.from => continue,
                Some(Ok(message)) => return Some(Ok(message)),
                Some(Err(error)) => {
                    // What follows an error would have a hole before it.
                    (self.next_file, self.current) = (files.len(), None);
                    return Some(Err(error));
                }
                None => {}
            }
            self.current = Some(FileMessages::new(files.get(self.next_file)?, self.from));
            self.next_file += 1;
        }
    }
}

/// The messages of one file.
struct FileMessages {
    /// The blocks not loaded yet, the earliest last.
    waiting: Vec<(usize, Block)>,
    loaded: BinaryHeap<Reverse<Loaded>>,
    loaded_bytes: u64,
}

/// A loaded block with its messages, latest first; ordered by its next message, then by its place in the file.
struct Loaded {
    next: u64,
    place: usize,
    block: Arc<Vec<u8>>,
    messages: Vec<MessageRecord>,
}

impl FileMessages {
    /// Of those blocks that hold a message logged at `from` or later.
    fn new(file: &BagFile, from: u64) -> Self {
        let late_enough = |(_, block): &(usize, Block)| block.last >= from;
        let mut waiting: Vec<_> = file.blocks.iter().copied().enumerate().filter(late_enough).collect();
        waiting.sort_by_key(|&(place, block)| Reverse((block.first, place)));
        Self { waiting, loaded: BinaryHeap::new(), loaded_bytes: 0 }
    }

    /// Loads every block that may hold a message before the next one.
    fn load_due(&mut self, file: &BagFile) -> Result<(), BagError> {
        while let Some(&(place, block)) = self.waiting.last() {
            if self.loaded.peek().is_some_and(|Reverse(loaded)| loaded.next < block.first) {
                break;
            }
            self.waiting.pop();
            let records = file.load(&block).map_err(BagError::io(&file.path))?;
            let changed = || BagError::Changed { path: file.path.clone(), offset: block.offset };
            let records = records.ok_or_else(changed)?;
            let messages = messages_of(file, &records);
            self.loaded_bytes += cost(&records, &messages);
            let limit = file.memory_limit();
            if self.loaded_bytes > limit && !self.loaded.is_empty() {
                return Err(BagError::Disorder { path: file.path.clone(), limit });
            }
            if let Some(next) = messages.last().map(|message| message.log_time) {
                self.loaded.push(Reverse(Loaded { next, place, block: Arc::new(records), messages }));
            }
        }
        Ok(())
    }

    fn next(&mut self, file: &BagFile) -> Option<Result<BagMessage, BagError>> {
        if let Err(error) = self.load_due(file) {
            return Some(Err(error));
        }
        let Reverse(mut earliest) = self.loaded.pop()?;
        let message = earliest.messages.pop()?;
        let topic = file.channels.get(&message.channel).copied()?;
        let block = Arc::clone(&earliest.block);
        if let Some(following) = earliest.messages.last() {
            earliest.next = following.log_time;
            self.loaded.push(Reverse(earliest));
        } else {
            self.loaded_bytes = self.loaded.iter().map(|Reverse(l)| cost(&l.block, &l.messages)).sum();
        }
        let MessageRecord { sequence, log_time, publish_time, start, end, .. } = message;
        Some(Ok(BagMessage { topic, log_time, publish_time, sequence, block, start, end }))
    }
}

/// The messages of known channels in a block, the earliest last.
fn messages_of(file: &BagFile, records: &[u8]) -> Vec<MessageRecord> {
    let mut messages = Vec::new();
    let mut at = 0;
    while let Some((opcode, start, end)) = record::record_at(records, at) {
        at = end;
        if opcode == op::MESSAGE {
            messages.extend(record::message(records, start, end).filter(|m| file.channels.contains_key(&m.channel)));
        }
    }
    // Reversed before the stable sort: of equal times the first written comes out first.
    messages.reverse();
    messages.sort_by_key(|message| Reverse(message.log_time));
    messages
}

fn cost(records: &[u8], messages: &[MessageRecord]) -> u64 {
    (records.len() + size_of_val(messages)) as u64
}

impl PartialEq for Loaded {
    fn eq(&self, other: &Self) -> bool {
        (self.next, self.place) == (other.next, other.place)
    }
}

impl Eq for Loaded {}

impl PartialOrd for Loaded {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Loaded {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        (self.next, self.place).cmp(&(other.next, other.place))
    }
}
