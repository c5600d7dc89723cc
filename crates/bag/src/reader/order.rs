//! Messages in the order of their log times.
//!
//! Recorders write chunks nearly in order, but messages may be logged out of order, and chunks, also of different files,
//! may overlap. Only chunks that overlap are held in memory together.

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
    /// The blocks not loaded yet, the earliest last.
    waiting: Vec<(Place, Block)>,
    loaded: BinaryHeap<Reverse<Loaded>>,
    /// What they keep in memory, bytes.
    loaded_bytes: u64,
    /// The most that they may.
    limit: u64,
    /// Messages before this log time are left out, ns.
    from: u64,
}

/// Numbers of a file and of a block in it: of equal times, what was written first comes first.
type Place = (usize, usize);

/// A loaded block with its messages, latest first; ordered by its next message, then by its place.
struct Loaded {
    next: u64,
    place: Place,
    bytes: u64,
    block: Arc<Vec<u8>>,
    messages: Vec<Entry>,
}

/// A message of a loaded block: its time and where its record begins.
#[derive(Clone, Copy)]
struct Entry {
    log_time: u64,
    at: usize,
}

impl<B: Borrow<BagReader>> Messages<B> {
    /// Those of blocks that hold a message logged at `from` (ns) or later.
    pub(super) fn new(bag: B, from: u64) -> Self {
        let files = &bag.borrow().files;
        let mut waiting: Vec<(Place, Block)> = Vec::new();
        for (number, file) in files.iter().enumerate() {
            let blocks = file.blocks.iter().enumerate().filter(|(_, block)| block.last >= from);
            waiting.extend(blocks.map(|(index, block)| ((number, index), *block)));
        }
        waiting.sort_by_key(|&(place, block)| Reverse((block.first, place)));
        let limit = files.iter().map(BagFile::overlap_limit).max().unwrap_or(0);
        Self { bag, waiting, loaded: BinaryHeap::new(), loaded_bytes: 0, limit, from }
    }

    /// Loads every block that may hold a message before the next one.
    fn load_due(&mut self) -> Result<(), BagError> {
        while let Some(&(place, block)) = self.waiting.last() {
            if self.loaded.peek().is_some_and(|Reverse(loaded)| loaded.next < block.first) {
                break;
            }
            self.waiting.pop();
            let Some(file) = self.bag.borrow().files.get(place.0) else { continue };
            if !self.loaded.is_empty() && self.loaded_bytes.saturating_add(block.cost()) > self.limit {
                return Err(BagError::Disorder { path: file.path.clone(), limit: self.limit });
            }
            let records = file.load(&block).map_err(BagError::io(&file.path))?;
            let changed = || BagError::Changed { path: file.path.clone(), offset: block.offset };
            let records = records.ok_or_else(changed)?;
            let messages = messages_of(file, &records);
            if let Some(next) = messages.last().map(|message| message.log_time) {
                let bytes = (records.len() + size_of_val(&*messages)) as u64;
                self.loaded_bytes += bytes;
                self.loaded.push(Reverse(Loaded { next, place, bytes, block: Arc::new(records), messages }));
            }
        }
        Ok(())
    }

    /// The next message, whenever it was logged.
    fn take(&mut self) -> Option<Result<BagMessage, BagError>> {
        if let Err(error) = self.load_due() {
            // What follows an error would have a hole before it.
            self.waiting.clear();
            self.loaded.clear();
            return Some(Err(error));
        }
        let Reverse(mut earliest) = self.loaded.pop()?;
        let entry = earliest.messages.pop()?;
        let block = Arc::clone(&earliest.block);
        let file = earliest.place.0;
        match earliest.messages.last() {
            Some(following) => {
                earliest.next = following.log_time;
                self.loaded.push(Reverse(earliest));
            }
            None => self.loaded_bytes = self.loaded_bytes.saturating_sub(earliest.bytes),
        }
        let (_, start, end) = record::record_at(&block, entry.at)?;
        let MessageRecord { channel, sequence, log_time, publish_time, start, end } =
            record::message(&block, start, end)?;
        let topic = self.bag.borrow().files.get(file)?.channels.get(&channel).copied()?;
        Some(Ok(BagMessage { topic, log_time, publish_time, sequence, block, start, end }))
    }
}

impl<B: Borrow<BagReader>> Iterator for Messages<B> {
    type Item = Result<BagMessage, BagError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            match self.take()? {
                Ok(message) if message.log_time < self.from => {}
                other => return Some(other),
            }
        }
    }
}

/// The messages of known channels in a block, the earliest last. The table is made to measure: of empty messages it
/// takes half as much as the block.
fn messages_of(file: &BagFile, records: &[u8]) -> Vec<Entry> {
    let known = || {
        let mut at = 0;
        std::iter::from_fn(move || {
            let from = at;
            let (opcode, start, end) = record::record_at(records, from)?;
            at = end;
            Some((from, opcode, start, end))
        })
        .filter(|&(_, opcode, ..)| opcode == op::MESSAGE)
        .filter_map(|(at, _, start, end)| Some((at, record::message(records, start, end)?)))
        .filter(|(_, message)| file.channels.contains_key(&message.channel))
    };
    let mut messages = Vec::with_capacity(known().count());
    messages.extend(known().map(|(at, message)| Entry { log_time: message.log_time, at }));
    // Of equal times the first written comes out first. Places make the order total: sorting needs no further memory.
    messages.sort_unstable_by_key(|entry| Reverse((entry.log_time, entry.at)));
    messages
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
