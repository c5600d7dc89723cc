//! CDR (XCDR version 1) as ROS 2 uses it: a four-byte encapsulation header, then fields in order, each primitive aligned
//! to its size, counted from the byte behind the header.
//!
//! [`WriteCdr`] and [`ReadCdr`] are the two directions. Writing is always little endian, into a slice that is already
//! there; reading takes both byte orders, can borrow strings and bytes in place, and never reserves memory for more
//! elements than the remaining bytes could hold.

mod array;
mod error;
mod primitive;
mod reader;
mod sequence;
mod text;
mod writer;

pub use error::CdrError;
pub use reader::{ReadCdr, Reader};
pub use sequence::{read_bounded, write_bounded};
pub use text::{read_bounded_string, write_bounded_string};
pub use writer::{Output, WriteCdr};

/// The bytes before the body: a 16-bit encapsulation kind (big endian) and 16 bits of options, which ROS 2 ignores.
pub const HEADER: usize = 4;
/// Encapsulation header of what we write: CDR, little endian.
pub const LITTLE_ENDIAN: [u8; HEADER] = [0, 1, 0, 0];

/// The number of bytes of header and body.
#[must_use]
pub fn encoded_len<T: WriteCdr + ?Sized>(message: &T) -> usize {
    let mut counter = writer::Counter::default();
    message.write(&mut counter);
    HEADER + counter.position()
}

/// Writes header and body into the front of `out` and gives the number of bytes written: less than [`encoded_len`] when
/// `out` is too short.
pub fn encode_into<T: WriteCdr + ?Sized>(message: &T, out: &mut [u8]) -> usize {
    let Some((header, body)) = out.split_first_chunk_mut::<HEADER>() else {
        return 0;
    };
    *header = LITTLE_ENDIAN;
    let mut writer = writer::Writer::new(body);
    message.write(&mut writer);
    HEADER + writer.position()
}

/// Reads a message behind its header. Bytes behind the message are ignored: transports pad to a multiple of four.
///
/// # Errors
/// When the bytes are not a `T`.
pub fn decode<'a, T: ReadCdr<'a>>(cdr: &'a [u8]) -> Result<T, CdrError> {
    T::read(&mut Reader::new(cdr)?, "the message")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Debug;

    fn check<T: WriteCdr + for<'a> ReadCdr<'a> + PartialEq + Debug>(value: T, little: &[u8], big: &[u8]) {
        let cdr = [&LITTLE_ENDIAN, little].concat();
        let mut out = vec![0xaa; encoded_len(&value)];
        assert_eq!(encode_into(&value, &mut out), out.len());
        assert_eq!(out, cdr);
        assert_eq!(decode::<T>(&cdr).as_ref(), Ok(&value));
        assert_eq!(decode::<T>(&[&[0; HEADER], big].concat()).as_ref(), Ok(&value));
    }

    /// A byte in front of a value: it shows the padding.
    #[derive(Debug, PartialEq)]
    struct Behind<T>(u8, T);

    impl<T: WriteCdr> WriteCdr for Behind<T> {
        fn write(&self, out: &mut impl Output) {
            self.0.write(out);
            self.1.write(out);
        }
    }

    impl<'a, T: ReadCdr<'a>> ReadCdr<'a> for Behind<T> {
        const SMALLEST: usize = 1 + T::SMALLEST;

        fn read(reader: &mut Reader<'a>, field: &'static str) -> Result<Self, CdrError> {
            Ok(Self(u8::read(reader, field)?, T::read(reader, field)?))
        }
    }

    #[test]
    fn numbers_are_aligned_to_their_size_behind_the_header() {
        check(Behind(1, 2_u8), &[1, 2], &[1, 2]);
        check(Behind(1, -2_i16), &[1, 0, 0xfe, 0xff], &[1, 0, 0xff, 0xfe]);
        check(Behind(1, 1.0_f32), &[1, 0, 0, 0, 0, 0, 0x80, 0x3f], &[1, 0, 0, 0, 0x3f, 0x80, 0, 0]);
        let (little, big) =
            ([1, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0], [1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2]);
        check(Behind(1, 2_u64), &little, &big);
    }

    #[test]
    fn sequences_begin_with_their_length_and_arrays_do_not() {
        check(vec![7_u8, 8], &[2, 0, 0, 0, 7, 8], &[0, 0, 0, 2, 7, 8]);
        check([7_u16, 8], &[7, 0, 8, 0], &[0, 7, 0, 8]);
        // No element, no padding in front of it.
        check(Vec::<f64>::new(), &[0, 0, 0, 0], &[0, 0, 0, 0]);
        check([true, false], &[1, 0], &[1, 0]);
        check(
            Behind(1, vec![Behind(2, 3_u16)]),
            &[1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 3, 0],
            &[1, 0, 0, 0, 0, 0, 0, 1, 2, 0, 0, 3],
        );
    }

    #[test]
    fn strings_end_with_a_zero_that_counts() {
        check("hé".to_owned(), &[4, 0, 0, 0, b'h', 0xc3, 0xa9, 0], &[0, 0, 0, 4, b'h', 0xc3, 0xa9, 0]);
        check(String::new(), &[1, 0, 0, 0, 0], &[0, 0, 0, 1, 0]);
        assert_eq!(decode::<&str>(&[0, 1, 0, 0, 0, 0, 0, 0]), Ok(""), "without its zero, as some writers do");
        assert_eq!(decode::<&str>(&[0, 1, 0, 0, 1, 0, 0, 0, b'x']), Err(CdrError::String("the message")));
        assert_eq!(decode::<&str>(&[0, 1, 0, 0, 2, 0, 0, 0, 0xff, 0]), Err(CdrError::String("the message")));
    }

    #[test]
    fn what_is_too_long_for_its_type_is_cut_in_writing_and_refused_in_reading() {
        struct Short;
        impl WriteCdr for Short {
            fn write(&self, out: &mut impl Output) {
                write_bounded(&[1_u8, 2, 3], 2, out);
                out.align(4);
                // The bound falls into the second character.
                write_bounded_string("aé", 2, out);
            }
        }
        let mut out = [0; 32];
        let written = encode_into(&Short, &mut out);
        assert_eq!(out[..written], [0, 1, 0, 0, 2, 0, 0, 0, 1, 2, 0, 0, 2, 0, 0, 0, b'a', 0]);
        let mut reader = Reader::new(&out).expect("a header");
        let refused = CdrError::Bound { field: "few", length: 2, bound: 1 };
        assert_eq!(read_bounded::<u8>(&mut reader.clone(), 1, "few"), Err(refused));
        assert_eq!(read_bounded::<u8>(&mut reader, 2, "few"), Ok(vec![1, 2]));
        let refused = CdrError::Bound { field: "text", length: 1, bound: 0 };
        assert_eq!(read_bounded_string(&mut reader.clone(), 0, "text"), Err(refused));
        assert_eq!(read_bounded_string(&mut reader, 1, "text"), Ok("a"));
    }

    #[test]
    fn errors_say_what_is_missing() {
        let short = |length, needed| CdrError::Short { length, needed, field: "the message" };
        assert_eq!(decode::<u64>(&[0, 1, 0, 0, 1, 2]), Err(short(6, 6)));
        let lengths = decode::<Vec<u64>>(&[0, 1, 0, 0, 0xff, 0xff, 0xff, 0xff, 0]);
        assert_eq!(lengths, Err(short(9, (u32::MAX as usize) * 8 - 1)));
        assert_eq!(decode::<bool>(&[0, 1, 0, 0, 2]), Err(CdrError::Bool("the message")));
        assert_eq!(decode::<u8>(&[0, 3, 0, 0, 2]), Err(CdrError::Encapsulation(3)));
        let header = CdrError::Short { length: 3, needed: 1, field: "the encapsulation header" };
        assert_eq!(decode::<u8>(&[0, 1, 0]), Err(header));
    }
}
