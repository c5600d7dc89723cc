//! Arrays of a fixed length: elements without a length.

use super::{CdrError, Output, ReadCdr, Reader, WriteCdr};

impl<T: WriteCdr, const N: usize> WriteCdr for [T; N] {
    fn write(&self, out: &mut impl Output) {
        T::write_many(self, out);
    }
}

impl<'a, T: ReadCdr<'a> + Default, const N: usize> ReadCdr<'a> for [T; N] {
    const SMALLEST: usize = N * T::SMALLEST;

    fn read(reader: &mut Reader<'a>, field: &'static str) -> Result<Self, CdrError> {
        reader.require(Self::SMALLEST, field)?;
        let mut array = std::array::from_fn(|_| T::default());
        for element in &mut array {
            *element = T::read(reader, field)?;
        }
        Ok(array)
    }
}
