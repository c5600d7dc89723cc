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
