//! One file of a bag: where its blocks of records are, and how to load one.

use super::chunk;
use super::record::{self, MAX_CHUNK_HEADER, PREFIX};
use std::collections::BTreeMap;
use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;
use std::path::PathBuf;

/// What a reader keeps in memory beyond the size of the file.
const ALLOWANCE: u64 = 32 << 20;

/// A run of records that is loaded as a whole: a chunk, or messages outside chunks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block {
    pub(super) offset: u64,
    pub(super) length: u64,
    pub(super) is_chunk: bool,
    /// Smallest and largest log time of its messages, ns.
    pub(super) first: u64,
    pub(super) last: u64,
    /// What its records take in memory, bytes.
    pub(super) memory: u64,
}

impl Block {
    /// What it takes at most to load it and to keep it with the table of its messages, bytes.
    pub(super) fn cost(&self) -> u64 {
        (self.memory + self.memory / 16 * 9).max(self.memory + self.length)
    }
}

/// An open file and what a scan has found in it.
pub(super) struct BagFile {
    pub(super) path: PathBuf,
    pub(super) file: File,
    pub(super) length: u64,
    /// The topic of each channel, an index into the topics of the bag.
    pub(super) channels: BTreeMap<u16, usize>,
    /// The blocks with intact messages.
    pub(super) blocks: Vec<Block>,
}

impl BagFile {
    /// The most that the records of one block may take.
    pub(super) fn memory_limit(&self) -> u64 {
        self.length + ALLOWANCE
    }

    /// The most that blocks which overlap in time may take together.
    pub(super) fn overlap_limit(&self) -> u64 {
        2 * self.length + ALLOWANCE
    }

    /// The bytes from `offset`, at most `length` of them and no more than the file has.
    pub(super) fn read(&self, offset: u64, length: u64) -> io::Result<Vec<u8>> {
        let length = length.min(self.length.saturating_sub(offset));
        let mut bytes = vec![0; usize::try_from(length).map_err(io::Error::other)?];
        self.file.read_exact_at(&mut bytes, offset)?;
        Ok(bytes)
    }

    /// CRC-32 of the first `length` bytes.
    pub(super) fn checksum(&self, length: u64) -> io::Result<u32> {
        let mut hasher = crc32fast::Hasher::new();
        let mut buffer = vec![0; 1 << 16];
        let mut at = 0;
        while at < length {
            let part = (length - at).min(buffer.len() as u64) as usize;
            let bytes = buffer.get_mut(..part).unwrap_or_default();
            self.file.read_exact_at(bytes, at)?;
            hasher.update(bytes);
            at += part as u64;
        }
        Ok(hasher.finalize())
    }

    /// The records of a block; nothing where they are no longer what the scan has found.
    pub(super) fn load(&self, block: &Block) -> io::Result<Option<Vec<u8>>> {
        let bytes = self.read(block.offset, block.length)?;
        if !block.is_chunk {
            return Ok(Some(bytes));
        }
        let Some(body) = bytes.get(PREFIX..) else { return Ok(None) };
        let head = body.get(..MAX_CHUNK_HEADER).unwrap_or(body);
        let Some((header, skip)) = record::chunk_header(head, body.len() as u64) else { return Ok(None) };
        Ok(chunk::decompress(&header, body.get(skip..).unwrap_or_default(), self.memory_limit()).ok())
    }
}
