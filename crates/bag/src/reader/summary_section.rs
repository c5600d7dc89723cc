//! The summary at the end of a finished file: schemas and channels again, and how many messages there should be.

use super::file::BagFile;
use super::record;
use mcap::records::{Channel, Record, op};
use std::collections::BTreeMap;

/// Footer record and closing magic.
const FOOTER: u64 = 9 + 20 + 8;

/// What the summary repeats.
#[derive(Default)]
pub(super) struct SummarySection {
    /// Type name and definition by schema id.
    pub(super) schemas: BTreeMap<u16, (String, String)>,
    pub(super) channels: Vec<Channel>,
    /// How many messages the whole file holds.
    pub(super) message_count: Option<u64>,
}

/// Reads the summary if the file has an intact one.
pub(super) fn read(file: &BagFile) -> Option<SummarySection> {
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
    Some(parse(&bytes))
}

fn parse(bytes: &[u8]) -> SummarySection {
    let mut summary = SummarySection::default();
    let mut at = 0;
    while let Some((opcode, start, end)) = record::record_at(bytes, at) {
        match mcap::parse_record(opcode, bytes.get(start..end).unwrap_or_default()) {
            Ok(Record::Schema { header, data }) => {
                summary.schemas.insert(header.id, (header.name, String::from_utf8_lossy(&data).into_owned()));
            }
            Ok(Record::Channel(channel)) => summary.channels.push(channel),
            Ok(Record::Statistics(statistics)) => summary.message_count = Some(statistics.message_count),
            _ => {}
        }
        at = end;
    }
    summary
}
