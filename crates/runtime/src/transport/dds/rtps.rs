//! The pieces of an RTPS message (RTPS 2.5, 8.3.7 and 9.4), little-endian, for what we send beside RustDDS.

use rustdds::GUID;

/// Bytes of a GUID that name the participant.
pub(super) const PREFIX: usize = 12;
pub(super) const INFO_TS: u8 = 0x09;
pub(super) const INFO_DST: u8 = 0x0e;
pub(super) const DATA: u8 = 0x15;
pub(super) const DATA_FRAG: u8 = 0x16;
pub(super) const HAS_INLINE_QOS: u8 = 2;
pub(super) const HAS_DATA: u8 = 4;
pub(super) const SENTINEL: u16 = 1;
pub(super) const RELATED_SAMPLE_IDENTITY: u16 = 0x0083;
/// As Fast DDS called it first.
pub(super) const RELATED_SAMPLE_IDENTITY_CUSTOM: u16 = 0x800f;
const LITTLE_ENDIAN: u8 = 1;

/// What every message begins with: who speaks.
pub(super) fn header(message: &mut Vec<u8>, writer_prefix: &[u8]) {
    message.extend(b"RTPS");
    message.extend([2, 4]); // protocol version
    message.extend([1, 18]); // vendor: the participant's, RustDDS
    message.extend(writer_prefix);
}

/// One part of a message.
pub(super) fn submessage(message: &mut Vec<u8>, kind: u8, flags: u8, content: &[u8]) {
    message.extend([kind, LITTLE_ENDIAN | flags]);
    // 0 says, of the last one, that it goes to the end.
    message.extend(u16::try_from(content.len()).unwrap_or(0).to_le_bytes());
    message.extend(content);
}

/// High half first, each half little-endian.
pub(super) fn sequence_number(number: i64) -> impl Iterator<Item = u8> {
    let high = (number >> 32) as i32;
    let low = number as u32;
    high.to_le_bytes().into_iter().chain(low.to_le_bytes())
}

/// Which participant an end belongs to.
pub(super) fn prefix(end: GUID) -> [u8; PREFIX] {
    let bytes = end.to_bytes();
    std::array::from_fn(|index| bytes[index])
}
