//! The pieces of an RTPS message (RTPS 2.5, 8.3.7 and 9.4), little-endian, for what we send beside RustDDS.

use rustdds::GUID;

/// Bytes of a GUID that name the participant.
pub(super) const PREFIX: usize = 12;
/// Bytes of a message before its first part.
const HEADER: usize = 8 + PREFIX;
const PAD: u8 = 0x01;
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

/// The parts of a message, as kind and content; ends where it makes no sense. Of either byte order.
pub(super) fn submessages(message: &[u8]) -> impl Iterator<Item = (u8, &[u8])> {
    let mut rest = message.get(HEADER..).unwrap_or_default();
    std::iter::from_fn(move || {
        let ([kind, flags, length @ ..], content) = rest.split_first_chunk::<4>()?;
        let is_little = flags & LITTLE_ENDIAN != 0;
        let length = usize::from(if is_little { u16::from_le_bytes(*length) } else { u16::from_be_bytes(*length) });
        // Of the last part 0 may say that it goes to the end; these two may be empty.
        let goes_on = length == 0 && ![PAD, INFO_TS].contains(kind);
        let content = if goes_on { content } else { content.get(..length)? };
        rest = rest.get(4 + content.len()..)?;
        Some((*kind, content))
    })
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

#[cfg(test)]
mod tests {
    use super::{DATA, INFO_DST, INFO_TS, header, submessage, submessages};

    #[test]
    fn a_message_comes_apart_as_it_was_put_together() {
        let mut message = Vec::new();
        header(&mut message, &[7; 12]);
        submessage(&mut message, INFO_TS, 2, &[]); // no time
        submessage(&mut message, INFO_DST, 0, &[1; 12]);
        submessage(&mut message, DATA, 4, &[2; 40]);
        message.extend([DATA, 0, 0, 4, 3, 3, 3, 3]); // big-endian
        message.extend([DATA, 1, 0, 0, 4, 4]); // to the end
        let all = [(INFO_TS, &[][..]), (INFO_DST, &[1; 12]), (DATA, &[2; 40]), (DATA, &[3; 4]), (DATA, &[4; 2])];
        assert_eq!(submessages(&message).collect::<Vec<_>>(), all);
        // Cut off wherever, it ends before.
        for length in 0..message.len() {
            let count = submessages(&message[..length]).filter(|part| !all.contains(part)).count();
            assert!(count <= 1, "{length}");
        }
        assert_eq!(submessages(&message[..50]).count(), 2);
    }
}
