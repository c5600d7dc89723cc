//! Reading.

use super::{CdrError, HEADER};

/// A type that can be read from CDR. `'a` is the life of the bytes: borrowed strings and pixels point into them.
pub trait ReadCdr<'a>: Sized {
    /// The fewest bytes a value takes, padding not counted; at least 1. It bounds what a length field can justify.
    const SMALLEST: usize;

    /// Reads one value; `field` is what errors name.
    ///
    /// # Errors
    /// When the bytes are not such a value.
    fn read(reader: &mut Reader<'a>, field: &'static str) -> Result<Self, CdrError>;

    /// Reads `count` values, of which the caller knows that the remaining bytes could hold them.
    ///
    /// # Errors
    /// When the bytes are not such values.
    fn read_many(reader: &mut Reader<'a>, count: usize, field: &'static str) -> Result<Vec<Self>, CdrError> {
        let mut values = Vec::with_capacity(count);
        for _ in 0..count {
            values.push(Self::read(reader, field)?);
        }
        Ok(values)
    }
}

/// A place in the body of a message.
#[derive(Debug, Clone)]
pub struct Reader<'a> {
    body: &'a [u8],
    position: usize,
    big_endian: bool,
}

impl<'a> Reader<'a> {
    /// Behind the encapsulation header of `cdr`.
    ///
    /// # Errors
    /// When there is no header, or one of another encapsulation.
    pub fn new(cdr: &'a [u8]) -> Result<Self, CdrError> {
        let Some((&[high, low, ..], body)) = cdr.split_first_chunk::<HEADER>() else {
            let needed = HEADER - cdr.len();
            return Err(CdrError::Short { length: cdr.len(), needed, field: "the encapsulation header" });
        };
        match u16::from_be_bytes([high, low]) {
            kind @ (0 | 1) => Ok(Self { body, position: 0, big_endian: kind == 0 }),
            kind => Err(CdrError::Encapsulation(kind)),
        }
    }

    /// The bytes not yet read.
    #[inline]
    #[must_use]
    pub const fn remaining(&self) -> usize {
        self.body.len() - self.position
    }

    /// Whether the bytes are big endian.
    #[inline]
    #[must_use]
    pub const fn big_endian(&self) -> bool {
        self.big_endian
    }

    /// Checks that `count` more bytes are there.
    ///
    /// # Errors
    /// When they are not.
    #[inline]
    pub fn require(&self, count: usize, field: &'static str) -> Result<(), CdrError> {
        match count.checked_sub(self.remaining()) {
            None | Some(0) => Ok(()),
            Some(needed) => Err(CdrError::Short { length: HEADER + self.body.len(), needed, field }),
        }
    }

    /// Skips padding up to a multiple of `alignment`, a power of two. Does nothing at the end of the bytes: what is read
    /// next finds them too short.
    #[inline]
    pub fn align(&mut self, alignment: usize) {
        self.position = self.position.next_multiple_of(alignment).min(self.body.len());
    }

    /// The next `count` bytes, in place.
    ///
    /// # Errors
    /// When they are not there.
    #[inline]
    pub fn take(&mut self, count: usize, field: &'static str) -> Result<&'a [u8], CdrError> {
        self.require(count, field)?;
        let taken = &self.body[self.position..self.position + count];
        self.position += count;
        Ok(taken)
    }

    /// The next `N` bytes, aligned to `N`.
    ///
    /// # Errors
    /// When they are not there.
    #[inline]
    pub fn take_aligned<const N: usize>(&mut self, field: &'static str) -> Result<[u8; N], CdrError> {
        self.align(N);
        let mut taken = [0; N];
        taken.copy_from_slice(self.take(N, field)?);
        Ok(taken)
    }

    /// The length of a sequence or string whose elements take at least `smallest` bytes each.
    ///
    /// # Errors
    /// When the remaining bytes cannot hold so many: nothing has been reserved for them by then.
    #[inline]
    pub fn length(&mut self, smallest: usize, field: &'static str) -> Result<usize, CdrError> {
        let length = u32::read(self, field)? as usize;
        self.require(length.saturating_mul(smallest), field)?;
        Ok(length)
    }
}
