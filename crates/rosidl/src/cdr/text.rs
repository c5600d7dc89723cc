//! Strings: a 32-bit length that counts the terminating zero, UTF-8, the zero.

use super::{CdrError, Output, ReadCdr, Reader, WriteCdr};

/// The greatest length that leaves room for the terminating zero in a 32-bit count.
const LONGEST: usize = u32::MAX as usize - 1;

impl WriteCdr for &str {
    fn write(&self, out: &mut impl Output) {
        write_bounded_string(self, LONGEST, out);
    }
}

impl WriteCdr for String {
    fn write(&self, out: &mut impl Output) {
        self.as_str().write(out);
    }
}

/// In place: the string points into the bytes read.
impl<'a> ReadCdr<'a> for &'a str {
    const SMALLEST: usize = 4;

    fn read(reader: &mut Reader<'a>, field: &'static str) -> Result<Self, CdrError> {
        let length = reader.length(1, field)?;
        // Some writers send an empty string without its zero; Fast DDS accepts that and so do we.
        let text = match reader.take(length, field)?.split_last() {
            None => &[],
            Some((0, text)) => text,
            Some(_) => return Err(CdrError::String(field)),
        };
        std::str::from_utf8(text).map_err(|_| CdrError::String(field))
    }
}

impl<'a> ReadCdr<'a> for String {
    const SMALLEST: usize = 4;

    fn read(reader: &mut Reader<'a>, field: &'static str) -> Result<Self, CdrError> {
        <&str>::read(reader, field).map(str::to_owned)
    }
}

/// Writes a string of at most `bound` bytes. A longer one is cut before the character that does not fit.
pub fn write_bounded_string(text: &str, bound: usize, out: &mut impl Output) {
    let text = &text[..text.floor_char_boundary(bound.min(LONGEST))];
    (text.len() as u32 + 1).write(out);
    out.put(text.as_bytes());
    out.put(&[0]);
}

/// Reads a string of at most `bound` bytes.
///
/// # Errors
/// When there are more, or the bytes are not such a string.
pub fn read_bounded_string<'a>(
    reader: &mut Reader<'a>,
    bound: usize,
    field: &'static str,
) -> Result<&'a str, CdrError> {
    let text = <&str>::read(reader, field)?;
    if text.len() > bound {
        return Err(CdrError::Bound { field, length: text.len(), bound });
    }
    Ok(text)
}
