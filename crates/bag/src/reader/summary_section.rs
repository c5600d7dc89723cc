//! The summary at the end of a finished file: schemas and channels again, and how many messages there should be.
//!
//! A file whose data agree with their checksum is as it was written, and then its summary can be believed: nothing need be
//! decompressed to know that the file is intact and what it holds.

use super::file::BagFile;
use super::record;
use super::scan::LARGEST_DEFINITION;
use super::scan::channels::Channels;
use mcap::records::{Record, Statistics, op};

/// Footer record and closing magic.
const FOOTER: u64 = 9 + 20 + 8;
/// The record that ends the data.
const DATA_END: u64 = 9 + 4;

/// What an intact summary says of a file.
pub(super) struct Summary {
    pub(super) statistics: Statistics,
    /// Whether every byte in front of the summary is as it was written.
    pub(super) is_vouched: bool,
}

/// Reads the summary if the file has an intact one: all channels, in case that the chunk that defines them is lost, and
/// how many messages the whole file holds.
pub(super) fn read(file: &BagFile, channels: &mut Channels<'_>) -> Option<Summary> {
    let footer_offset = file.length.checked_sub(FOOTER)?;
    let tail = file.read(footer_offset, FOOTER).ok()?;
    if tail.get(29..)? != mcap::MAGIC || record::prefix(&tail)? != (op::FOOTER, 20) {
        return None;
    }
    let Ok(Record::Footer(footer)) = mcap::parse_record(op::FOOTER, tail.get(9..29)?) else { return None };
    if footer.summary_start == 0 {
        return None;
    }
    let mut bytes = file.read(footer.summary_start, footer_offset.checked_sub(footer.summary_start)?).ok()?;
    let summary_length = bytes.len();
    bytes.extend_from_slice(tail.get(..25)?);
    // The checksum covers the footer up to itself. Without one the summary cannot be trusted to repair anything.
    if footer.summary_crc == 0 || crc32fast::hash(&bytes) != footer.summary_crc {
        return None;
    }
    bytes.truncate(summary_length);
    let statistics = parse(&bytes, channels)?;
    Some(Summary { statistics, is_vouched: is_intact(file, footer.summary_start).unwrap_or(false) })
}

/// Whether the data in front of the summary have a checksum and agree with it.
fn is_intact(file: &BagFile, summary_start: u64) -> Option<bool> {
    let data_length = summary_start.checked_sub(DATA_END)?;
    let end = file.read(data_length, DATA_END).ok()?;
    let expected = u32::from_le_bytes(*end.get(9..)?.first_chunk()?);
    let is_end = record::prefix(&end)? == (op::DATA_END, 4);
    Some(is_end && expected != 0 && file.checksum(data_length).ok()? == expected)
}

fn parse(bytes: &[u8], channels: &mut Channels<'_>) -> Option<Statistics> {
    // Channels name their schemas, which may stand behind them.
    for wanted in [op::SCHEMA, op::CHANNEL] {
        for (opcode, body) in records(bytes).filter(|&(opcode, body)| opcode == wanted && is_believed(body)) {
            match mcap::parse_record(opcode, body) {
                Ok(Record::Schema { header, data }) => channels.add_schema(header.id, header.name, &data),
                Ok(Record::Channel(channel)) => channels.add_channel(channel),
                _ => {}
            }
        }
    }
    let mut statistics = records(bytes).filter(|&(opcode, body)| opcode == op::STATISTICS && is_believed(body));
    let (opcode, body) = statistics.next()?;
    match mcap::parse_record(opcode, body) {
        Ok(Record::Statistics(statistics)) => Some(statistics),
        _ => None,
    }
}

fn is_believed(body: &[u8]) -> bool {
    body.len() <= LARGEST_DEFINITION
}

/// Opcode and body of each record.
fn records(bytes: &[u8]) -> impl Iterator<Item = (u8, &[u8])> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let (opcode, start, end) = record::record_at(bytes, at)?;
        at = end;
        Some((opcode, bytes.get(start..end)?))
    })
}
