//! The outermost layer of the serial line: body, CRC-16, byte stuffing (COBS), delimiter.
//!
//! A zero byte ends every frame and occurs nowhere else, so that a receiver that starts in the middle of a frame, or
//! has lost bytes, is in step again at the next zero.

use crate::LinkError;

/// The longest body of a frame, in bytes.
pub const MAX_BODY: usize = 250;

/// The longest run of bytes between two delimiters: body and checksum with one byte of stuffing.
pub const MAX_STUFFED: usize = MAX_BODY + 2 + 1;

/// Ends every frame.
pub const DELIMITER: u8 = 0;

/// CRC-16 with polynomial 0x1021 and start value 0xffff (catalogue name CRC-16/IBM-3740).
const CHECKSUM: crc::Crc<u16> = crc::Crc::<u16>::new(&crc::CRC_16_IBM_3740);

/// Appends the frame of `body` to `out`: what goes over the line. A body beyond [`MAX_BODY`] is not framed.
pub fn frame(body: &[u8], out: &mut Vec<u8>) {
    if body.len() > MAX_BODY {
        return;
    }
    let mut checked = [0; MAX_BODY + 2];
    checked[..body.len()].copy_from_slice(body);
    checked[body.len()..body.len() + 2].copy_from_slice(&CHECKSUM.checksum(body).to_le_bytes());
    let start = out.len();
    out.resize(start + MAX_STUFFED, 0);
    let stuffed = cobs::encode(&checked[..body.len() + 2], &mut out[start..]);
    out.truncate(start + stuffed);
    out.push(DELIMITER);
}

/// The body of the bytes before a delimiter, unstuffed in place.
///
/// # Errors
/// When stuffing or checksum are wrong.
pub fn unframe(stuffed: &mut [u8]) -> Result<&[u8], LinkError> {
    let length = cobs::decode_in_place(stuffed).map_err(|_| LinkError::Stuffing)?;
    let checked = stuffed.get(..length).ok_or(LinkError::Stuffing)?;
    let (body, checksum) = checked.split_last_chunk::<2>().ok_or(LinkError::Short(length))?;
    let (found, computed) = (u16::from_le_bytes(*checksum), CHECKSUM.checksum(body));
    if found == computed { Ok(body) } else { Err(LinkError::Checksum { found, computed }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_checksum_is_the_catalogue_s() {
        assert_eq!(CHECKSUM.checksum(b"123456789"), 0x29b1);
    }

    proptest! {
        #[test]
        fn bodies_come_back(body in proptest::collection::vec(any::<u8>(), 0..=MAX_BODY)) {
            let mut line = Vec::new();
            frame(&body, &mut line);
            prop_assert_eq!(line.iter().position(|&byte| byte == DELIMITER), Some(line.len() - 1));
            prop_assert!(line.len() <= body.len() + 4);
            line.pop();
            prop_assert_eq!(unframe(&mut line), Ok(&body[..]));
        }

        #[test]
        fn any_bytes_are_unframed_without_panic(mut bytes in proptest::collection::vec(any::<u8>(), 0..=MAX_STUFFED)) {
            let _ = unframe(&mut bytes);
        }

        #[test]
        fn a_flipped_bit_is_noticed(body in proptest::collection::vec(any::<u8>(), 1..60), at: prop::sample::Index, bit in 0..8u8) {
            let mut line = Vec::new();
            frame(&body, &mut line);
            line.pop();
            let index = at.index(line.len());
            line[index] ^= 1 << bit;
            prop_assert_ne!(unframe(&mut line), Ok(&body[..]));
        }
    }
}
