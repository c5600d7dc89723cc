//! Numbers and booleans.

use super::{CdrError, Output, ReadCdr, Reader, WriteCdr};

macro_rules! number {
    ($type:ty) => {
        impl WriteCdr for $type {
            #[inline]
            fn write(&self, out: &mut impl Output) {
                out.align(size_of::<Self>());
                out.put(&self.to_le_bytes());
            }

            /// The first one aligns all.
            fn write_many(values: &[Self], out: &mut impl Output) {
                if values.is_empty() {
                    return;
                }
                out.align(size_of::<Self>());
                out.put_with(size_of_val(values), |space| {
                    for (place, value) in space.chunks_exact_mut(size_of::<Self>()).zip(values) {
                        place.copy_from_slice(&value.to_le_bytes());
                    }
                });
            }
        }

        impl<'a> ReadCdr<'a> for $type {
            const SMALLEST: usize = size_of::<Self>();

            #[inline]
            fn read(reader: &mut Reader<'a>, field: &'static str) -> Result<Self, CdrError> {
                let bytes = reader.take_aligned(field)?;
                Ok(if reader.big_endian() { Self::from_be_bytes(bytes) } else { Self::from_le_bytes(bytes) })
            }
        }
    };
}

number!(i8);
number!(i16);
number!(u16);
number!(i32);
number!(u32);
number!(i64);
number!(u64);
number!(f32);
number!(f64);

/// Bytes are written and read as blocks: images consist of them.
impl WriteCdr for u8 {
    fn write(&self, out: &mut impl Output) {
        out.put(&[*self]);
    }

    fn write_many(values: &[Self], out: &mut impl Output) {
        out.put(values);
    }
}

impl<'a> ReadCdr<'a> for u8 {
    const SMALLEST: usize = 1;

    fn read(reader: &mut Reader<'a>, field: &'static str) -> Result<Self, CdrError> {
        Ok(reader.take(1, field)?[0])
    }

    fn read_many(reader: &mut Reader<'a>, count: usize, field: &'static str) -> Result<Vec<Self>, CdrError> {
        Ok(reader.take(count, field)?.to_vec())
    }
}

impl WriteCdr for bool {
    fn write(&self, out: &mut impl Output) {
        out.put(&[u8::from(*self)]);
    }
}

impl<'a> ReadCdr<'a> for bool {
    const SMALLEST: usize = 1;

    fn read(reader: &mut Reader<'a>, field: &'static str) -> Result<Self, CdrError> {
        match u8::read(reader, field)? {
            0 => Ok(false),
            1 => Ok(true),
            _ => Err(CdrError::Bool(field)),
        }
    }
}
