//! Checksums of inputs that were changed, made right again: behind them parsers get to see what is wrong.

use crc::{CRC_16_IBM_3740, Crc};

const RADIO: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);

/// Of each frame of a serial line.
pub(crate) fn radio(bytes: &[u8]) -> Vec<u8> {
    let frames = bytes.split(|byte| *byte == 0).filter(|frame| !frame.is_empty());
    frames.flat_map(|frame| sealed_frame(frame).unwrap_or_else(|| frame.to_vec()).into_iter().chain([0])).collect()
}

fn sealed_frame(frame: &[u8]) -> Option<Vec<u8>> {
    let mut body = cobs::decode_vec(frame).ok()?;
    body.truncate(body.len().checked_sub(2)?);
    body.extend(RADIO.checksum(&body).to_le_bytes());
    Some(cobs::encode_vec(&body))
}

/// What the records of an MCAP file are called.
const FOOTER: u8 = 0x02;
const CHUNK: u8 = 0x06;
const DATA_END: u8 = 0x0f;

/// Of the chunks of an MCAP file that are not compressed; those of sections are left out, which a file may do.
pub(crate) fn mcap(bytes: &[u8]) -> Vec<u8> {
    let mut sealed = bytes.to_vec();
    let mut at = 8;
    while let Some((&opcode, rest)) = sealed.get(at..).and_then(<[u8]>::split_first) {
        let Some(length) = number(rest).filter(|length| *length <= rest.len().saturating_sub(8)) else { break };
        let (start, end) = (at + 9, at + 9 + length);
        let content = &mut sealed[start..end];
        match opcode {
            CHUNK => seal_chunk(content),
            DATA_END => put(content, 0, &[0; 4]),
            FOOTER => put(content, 16, &[0; 4]),
            _ => {}
        }
        at = end;
    }
    sealed
}

/// Two times, size, checksum, name of the compression, and records, with their lengths.
fn seal_chunk(content: &mut [u8]) {
    if content.get(28..32) != Some(&[0; 4]) {
        return;
    }
    let Some(records) = content.get(40..) else { return };
    let (checksum, length) = (crc32fast::hash(records), records.len() as u64);
    put(content, 16, &length.to_le_bytes());
    put(content, 24, &checksum.to_le_bytes());
    put(content, 32, &length.to_le_bytes());
}

fn put(content: &mut [u8], at: usize, bytes: &[u8]) {
    if let Some(place) = content.get_mut(at..at + bytes.len()) {
        place.copy_from_slice(bytes);
    }
}

fn number(bytes: &[u8]) -> Option<usize> {
    usize::try_from(u64::from_le_bytes(bytes.first_chunk::<8>().copied()?)).ok()
}

#[cfg(test)]
mod tests {
    use super::super::corpus;
    use trench_bag::BagReader;
    use trench_radio::StreamDecoder;

    fn frames(bytes: &[u8]) -> usize {
        let mut count = 0;
        StreamDecoder::default().push(bytes, |_| count += 1);
        count
    }

    #[test]
    fn spoilt_frames_pass_the_checksum_again() {
        for vector in corpus::radio() {
            assert_eq!((frames(&vector), super::radio(&vector)), (1, vector.clone()));
            let mut spoilt = vector.clone();
            let last = spoilt.len() - 4;
            spoilt[last] ^= 0x80;
            assert_eq!((frames(&spoilt), frames(&super::radio(&spoilt))), (0, 1), "{vector:x?}");
        }
    }

    /// How many messages come out of a bag with these bytes.
    fn messages(bytes: &[u8]) -> usize {
        let folder = super::super::in_memory();
        let file = folder.path().join("sealed.mcap");
        std::fs::write(&file, bytes).unwrap();
        BagReader::open(&file).map_or(0, |bag| bag.messages().flatten().count())
    }

    #[test]
    fn spoilt_messages_come_out_of_a_sealed_bag() {
        let bag = corpus::open_bags().swap_remove(0);
        let all = messages(&bag);
        assert!(all > 10, "{all}");
        let mut spoilt = bag.clone();
        // Far inside the first chunk, whose records are most of the file.
        let middle = spoilt.len() / 3;
        spoilt[middle] ^= 0x01;
        assert!(messages(&spoilt) < all);
        assert!(messages(&super::mcap(&spoilt)) > messages(&spoilt));
    }
}
