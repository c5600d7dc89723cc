//! The framing of MCAP records: an opcode, a length, a body.

use super::scan::LARGEST_DEFINITION;
use mcap::records::{ChunkHeader, Record, op};

/// Opcode and length in front of every record.
pub(super) const PREFIX: usize = 9;
/// The fixed fields of a message record, before its data.
const MESSAGE_HEADER: usize = 22;
/// The fixed fields of a chunk record, without the name of its compression.
const CHUNK_HEADER: usize = 40;
/// The longest chunk header worth considering: names of compressions are short.
pub(super) const MAX_CHUNK_HEADER: usize = CHUNK_HEADER + 16;

/// A message record inside a block of records.
#[derive(Debug, Clone, Copy)]
pub(super) struct MessageRecord {
    pub(super) channel: u16,
    pub(super) sequence: u32,
    pub(super) log_time: u64,
    pub(super) publish_time: u64,
    /// Where its data is in the block.
    pub(super) start: usize,
    pub(super) end: usize,
}

/// Opcode and body length of the record that `bytes` begin with.
pub(super) fn prefix(bytes: &[u8]) -> Option<(u8, u64)> {
    let (&opcode, rest) = bytes.split_first()?;
    Some((opcode, u64::from_le_bytes(*rest.first_chunk()?)))
}

/// The record at `at` of a block: opcode, start and end of its body. Nothing at the end of the block or where the
/// record reaches beyond it.
pub(super) fn record_at(block: &[u8], at: usize) -> Option<(u8, usize, usize)> {
    let (opcode, length) = prefix(block.get(at..)?)?;
    let start = at + PREFIX;
    let end = start.checked_add(usize::try_from(length).ok()?)?;
    (end <= block.len()).then_some((opcode, start, end))
}

/// Reads the message record whose body is `block[start..end]`.
pub(super) fn message(block: &[u8], start: usize, end: usize) -> Option<MessageRecord> {
    let body = block.get(start..end)?;
    Some(MessageRecord {
        channel: u16::from_le_bytes(*body.first_chunk()?),
        sequence: u32::from_le_bytes(*body.get(2..)?.first_chunk()?),
        log_time: u64::from_le_bytes(*body.get(6..)?.first_chunk()?),
        publish_time: u64::from_le_bytes(*body.get(14..)?.first_chunk()?),
        start: start + MESSAGE_HEADER,
        end,
    })
}

/// The chunk header that `body`, the beginning of a record of `length` bytes, holds, and its own length: only where
/// everything in it agrees, so that a chunk is known also behind a damaged opcode or found in the middle of a file.
pub(super) fn chunk_header(body: &[u8], length: u64) -> Option<(ChunkHeader, usize)> {
    let name_length = u32::from_le_bytes(*body.get(28..)?.first_chunk()?) as usize;
    let header_length = CHUNK_HEADER.checked_add(name_length).filter(|&length| length <= body.len())?;
    let name = std::str::from_utf8(body.get(32..32 + name_length)?).ok()?;
    let compressed_size = u64::from_le_bytes(*body.get(header_length - 8..)?.first_chunk()?);
    let known = matches!(name, "" | "zstd" | "lz4");
    if !known || compressed_size.checked_add(header_length as u64) != Some(length) {
        return None;
    }
    let header = ChunkHeader {
        message_start_time: u64::from_le_bytes(*body.first_chunk()?),
        message_end_time: u64::from_le_bytes(*body.get(8..)?.first_chunk()?),
        uncompressed_size: u64::from_le_bytes(*body.get(16..)?.first_chunk()?),
        uncompressed_crc: u32::from_le_bytes(*body.get(24..)?.first_chunk()?),
        compression: name.to_owned(),
        compressed_size,
    };
    Some((header, header_length))
}

/// Whether a record outside chunks can be what it says: known, and its body reads as such.
pub(super) fn is_plausible(opcode: u8, body: &[u8]) -> bool {
    if matches!(opcode, op::SCHEMA | op::CHANNEL) && body.len() > LARGEST_DEFINITION {
        return true; // It is refused later.
    }
    match mcap::parse_record(opcode, body) {
        Ok(Record::MessageIndex(index)) => body.len() == 6 + 16 * index.records.len(),
        Ok(Record::DataEnd(_)) => body.len() == 4,
        Ok(Record::Chunk { .. }) => false, // `chunk_header` did not take it.
        Ok(Record::Unknown { .. }) => opcode >= 0x80, // Private records are legal, the others are reserved.
        Ok(_) => true,
        Err(_) => false,
    }
}

/// Whether a record is skipped without a look at its body, which may be large.
pub(super) fn is_skipped(opcode: u8, length: u64) -> bool {
    let is_long = length > LARGEST_DEFINITION as u64;
    opcode == op::ATTACHMENT || opcode >= 0x80 || (opcode == op::METADATA && is_long)
}
