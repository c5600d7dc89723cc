//! Sequences: a 32-bit length, then the elements.

use super::{CdrError, Output, ReadCdr, Reader, WriteCdr};

impl<T: WriteCdr> WriteCdr for Vec<T> {
    fn write(&self, out: &mut impl Output) {
        write_bounded(self, u32::MAX as usize, out);
    }
}

impl<'a, T: ReadCdr<'a>> ReadCdr<'a> for Vec<T> {
    const SMALLEST: usize = 4;

    fn read(reader: &mut Reader<'a>, field: &'static str) -> Result<Self, CdrError> {
        let length = reader.length(T::SMALLEST, field)?;
        T::read_many(reader, length, field)
    }
}

impl WriteCdr for &[u8] {
    fn write(&self, out: &mut impl Output) {
        write_bounded(self, u32::MAX as usize, out);
    }
}

/// In place: the slice points into the bytes read.
impl<'a> ReadCdr<'a> for &'a [u8] {
    const SMALLEST: usize = 4;

    fn read(reader: &mut Reader<'a>, field: &'static str) -> Result<Self, CdrError> {
        let length = reader.length(1, field)?;
        reader.take(length, field)
    }
}

/// Writes a sequence of at most `bound` elements. A longer one is cut: no receiver would accept it.
pub fn write_bounded<T: WriteCdr>(values: &[T], bound: usize, out: &mut impl Output) {
    let length = u32::try_from(values.len().min(bound)).unwrap_or(u32::MAX);
    length.write(out);
    T::write_many(&values[..length as usize], out);
}

/// Reads a sequence of at most `bound` elements.
///
/// # Errors
/// When there are more, or the bytes are not such a sequence.
pub fn read_bounded<'a, T: ReadCdr<'a>>(
    reader: &mut Reader<'a>,
    bound: usize,
    field: &'static str,
) -> Result<Vec<T>, CdrError> {
    let length = reader.length(T::SMALLEST, field)?;
    if length > bound {
        return Err(CdrError::Bound { field, length, bound });
    }
    T::read_many(reader, length, field)
}
