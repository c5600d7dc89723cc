//! The first pass over a file: finds its blocks, checks each, learns channels, counts messages, notes what is damaged.
//! Of a file that vouches for itself (see [`super::summary_section`]) it only finds the blocks.
//!
//! Where the framing breaks, the scan looks for the next chunk by its header and goes on there, so that damage in one
//! place costs one chunk.

pub(super) mod channels;
mod resync;

use super::file::{BagFile, Block};
use super::record::{self, MAX_CHUNK_HEADER, MessageRecord, PREFIX};
use super::summary_section::{self, Summary};
use super::{Topic, chunk};
use crate::BagError;
use channels::{Channels, Totals};
use mcap::records::{ChunkHeader, Record, op};
use std::fs::File;
use std::io;
use std::path::Path;

/// Messages outside chunks are gathered into blocks of no more than this many bytes.
const LOOSE_BLOCK: u64 = 1 << 20;
/// The most damage that is listed one by one.
const MOST_DAMAGE: usize = 1000;
/// The longest definition of a topic or type that is read, bytes.
pub(super) const LARGEST_DEFINITION: usize = 1 << 20;

/// What is enough to call a file intact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Trust {
    /// That its data agree with their checksum, and its summary with its own.
    Checksum,
    /// Nothing but a look into each chunk.
    Nothing,
}

/// A scanned file.
pub(super) struct Scanned {
    pub(super) file: BagFile,
    pub(super) damage: Vec<String>,
}

/// Scans the file at `path`, adding its topics and message counts to `topics`.
pub(super) fn scan(path: &Path, trust: Trust, topics: &mut Vec<Topic>) -> Result<Scanned, BagError> {
    let handle = File::open(path).map_err(BagError::io(path))?;
    let length = handle.metadata().map_err(BagError::io(path))?.len();
    let file =
        BagFile { path: path.to_owned(), file: handle, length, channels: Default::default(), blocks: Vec::new() };
    let mut channels = Channels::new(topics);
    let summary = summary_section::read(&file, &mut channels);
    let is_trusted = |summary: &Summary| trust == Trust::Checksum && summary.is_vouched;
    let is_vouched =
        summary.as_ref().is_some_and(|summary| is_trusted(summary) && channels.believe(&summary.statistics));
    let mut scan = Scan {
        file,
        channels,
        damage: Vec::new(),
        untold: 0,
        loose: Vec::new(),
        is_loose_open: false,
        finished: false,
        is_vouched,
    };
    let magic_is_good = scan.run().map_err(BagError::io(path))?;
    if !magic_is_good && scan.file.blocks.is_empty() {
        return Err(BagError::NotMcap(path.to_owned()));
    }
    scan.report_losses(summary.map(|summary| summary.statistics.message_count));
    let Scan { mut file, channels, damage, .. } = scan;
    file.channels = channels.finish();
    file.blocks.sort_by_key(|block| block.offset);
    Ok(Scanned { file, damage })
}

struct Scan<'a> {
    file: BagFile,
    channels: Channels<'a>,
    damage: Vec<String>,
    /// Damage beyond the most that is listed.
    untold: u64,
    /// Blocks of messages outside chunks, with the channel of each message.
    loose: Vec<(Block, Vec<u16>)>,
    /// Whether the next message can join the last of these blocks: nothing but small records is in between.
    is_loose_open: bool,
    finished: bool,
    /// Whether the file is as it was written, and its messages are counted already.
    is_vouched: bool,
}

impl Scan<'_> {
    /// Whether the file begins as an MCAP file.
    fn run(&mut self) -> io::Result<bool> {
        let magic = self.file.read(0, mcap::MAGIC.len() as u64)?;
        let magic_is_good = magic == mcap::MAGIC;
        let mut at = Some(mcap::MAGIC.len() as u64);
        if !magic_is_good {
            self.note("does not begin with the magic of an MCAP file".to_owned());
            at = self.resync(0)?;
        }
        while let Some(offset) = at.filter(|&offset| offset < self.file.length && !self.finished) {
            at = match self.record(offset)? {
                Some(next) => Some(next),
                None => self.resync(offset + 1)?,
            };
        }
        Ok(magic_is_good)
    }

    /// Handles the record at `offset` and gives where the next one begins; nothing where this is no intact record.
    fn record(&mut self, offset: u64) -> io::Result<Option<u64>> {
        let head = self.file.read(offset, (PREFIX + MAX_CHUNK_HEADER) as u64)?;
        let Some((opcode, length)) = record::prefix(&head) else { return Ok(None) };
        let body_offset = offset + PREFIX as u64;
        let Some(end) = body_offset.checked_add(length).filter(|&end| end <= self.file.length) else {
            return Ok(None);
        };
        let body_head = head.get(PREFIX..).unwrap_or_default();
        if let Some((header, skip)) = record::chunk_header(body_head, length) {
            let memory = header.uncompressed_size;
            let block = Block { offset, length: end - offset, is_chunk: true, first: 0, last: 0, memory };
            self.is_loose_open = false;
            let (first, last) = (header.message_start_time, header.message_end_time);
            // Also chunks without messages say that their times are zero.
            match self.is_vouched && last > 0 {
                true => self.file.blocks.push(Block { first, last, ..block }),
                false => self.chunk(block, &header, body_offset + skip as u64)?,
            }
            return Ok(Some(end));
        }
        self.is_loose_open &= length < LOOSE_BLOCK;
        if record::is_skipped(opcode, length) {
            return Ok(Some(end));
        }
        let body = self.file.read(body_offset, length)?;
        if !record::is_plausible(opcode, &body) {
            return Ok(None);
        }
        match opcode {
            op::MESSAGE => self.loose_message(offset, end, &body),
            op::DATA_END => self.data_end(offset, &body)?,
            _ => self.definition(opcode, &body),
        }
        Ok(Some(end))
    }

    fn chunk(&mut self, mut block: Block, header: &ChunkHeader, data_offset: u64) -> io::Result<()> {
        let compressed = self.file.read(data_offset, header.compressed_size)?;
        let records = match chunk::decompress(header, &compressed, self.file.memory_limit()) {
            Ok(records) => records,
            Err(bad) => {
                let (offset, problem) = (block.offset, bad.describe());
                self.note(format!("the chunk at byte {offset} {problem}: its messages are lost"));
                return Ok(());
            }
        };
        let mut span = None;
        let mut at = 0;
        while let Some((opcode, start, end)) = record::record_at(&records, at) {
            at = end;
            if opcode != op::MESSAGE {
                self.definition(opcode, records.get(start..end).unwrap_or_default());
            } else if let Some(message) = record::message(&records, start, end)
                && self.count(message.channel)
            {
                let (first, last) = span.unwrap_or((message.log_time, message.log_time));
                span = Some((first.min(message.log_time), last.max(message.log_time)));
            }
        }
        if at != records.len() {
            self.note(format!("the chunk at byte {} ends in the middle of a record", block.offset));
        }
        if let Some((first, last)) = span {
            (block.first, block.last) = (first, last);
            self.file.blocks.push(block);
        }
        Ok(())
    }

    /// Counts a message, unless the summary did. Whether its channel is known.
    fn count(&mut self, channel: u16) -> bool {
        if self.is_vouched { self.channels.is_known(channel) } else { self.channels.count(channel) }
    }

    fn loose_message(&mut self, offset: u64, end: u64, body: &[u8]) {
        let Some(MessageRecord { channel, log_time, .. }) = record::message(body, 0, body.len()) else { return };
        match self.loose.last_mut() {
            Some((block, channels)) if self.is_loose_open && end - block.offset <= LOOSE_BLOCK => {
                block.length = end - block.offset;
                block.memory = block.length;
                block.first = block.first.min(log_time);
                block.last = block.last.max(log_time);
                channels.push(channel);
            }
            _ => {
                let length = end - offset;
                let block = Block { offset, length, is_chunk: false, first: log_time, last: log_time, memory: length };
                self.loose.push((block, vec![channel]));
                self.is_loose_open = true;
            }
        }
    }

    /// Lists damage; no more of it than a person would read, and than memory should hold.
    fn note(&mut self, what: String) {
        match self.damage.len() < MOST_DAMAGE {
            true => self.damage.push(what),
            false => self.untold += 1,
        }
    }

    fn definition(&mut self, opcode: u8, body: &[u8]) {
        if body.len() > LARGEST_DEFINITION {
            return self.channels.refuse();
        }
        match mcap::parse_record(opcode, body) {
            Ok(Record::Schema { header, data }) => self.channels.add_schema(header.id, header.name, &data),
            Ok(Record::Channel(channel)) => self.channels.add_channel(channel),
            _ => {}
        }
    }

    /// The end of the data: its checksum is all that vouches for messages outside chunks.
    fn data_end(&mut self, offset: u64, body: &[u8]) -> io::Result<()> {
        self.finished = true;
        let expected = body.first_chunk().map_or(0, |bytes| u32::from_le_bytes(*bytes));
        if expected != 0 && !self.is_vouched && self.file.checksum(offset)? != expected {
            self.note("the data contradict their checksum".to_owned());
            let lost: usize = self.loose.drain(..).map(|(_, channels)| channels.len()).sum();
            if lost > 0 {
                self.note(format!("{lost} messages outside chunks are lost: which of them changed is unknown"));
            }
        }
        Ok(())
    }

    fn report_losses(&mut self, expected: Option<u64>) {
        for (block, channels) in std::mem::take(&mut self.loose) {
            let mut is_known = false;
            for channel in channels {
                is_known |= self.count(channel);
            }
            if is_known {
                self.file.blocks.push(block);
            }
        }
        if self.untold > 0 {
            self.damage.push(format!("and {} places more are damaged", self.untold));
        }
        let Totals { counted, unknown, refused } = self.channels.totals();
        if refused > 0 {
            self.damage.push(format!("{refused} definitions of topics or types are larger than can be believed"));
        }
        if !self.finished {
            self.damage.push(format!(
                "ends without a summary: its recorder was killed or its end is lost; {counted} messages are intact"
            ));
        }
        if unknown > 0 {
            self.damage.push(format!("{unknown} messages are lost with the definition of their topic"));
        }
        if let Some(expected) = expected.filter(|&expected| expected != counted) {
            self.damage.push(format!("{counted} of {expected} messages are intact"));
        }
    }
}
