//! Writing, and counting what would be written.

/// A type that can be written as CDR.
pub trait WriteCdr {
    /// Writes the value.
    fn write(&self, out: &mut impl Output);

    /// Writes values one after another, without a length.
    fn write_many(values: &[Self], out: &mut impl Output)
    where
        Self: Sized,
    {
        for value in values {
            value.write(out);
        }
    }
}

/// Where the body of a message goes.
pub trait Output {
    /// Adds zeros up to a multiple of `alignment`, a power of two.
    fn align(&mut self, alignment: usize);

    /// Adds `count` bytes that `fill` writes.
    fn put_with(&mut self, count: usize, fill: impl FnOnce(&mut [u8]));

    /// Adds bytes.
    #[inline]
    fn put(&mut self, bytes: &[u8]) {
        self.put_with(bytes.len(), |space| space.copy_from_slice(bytes));
    }
}

/// Counts.
#[derive(Debug, Default)]
pub(super) struct Counter {
    position: usize,
}

impl Counter {
    pub(super) const fn position(&self) -> usize {
        self.position
    }
}

impl Output for Counter {
    #[inline]
    fn align(&mut self, alignment: usize) {
        self.position = self.position.next_multiple_of(alignment);
    }

    #[inline]
    fn put_with(&mut self, count: usize, _: impl FnOnce(&mut [u8])) {
        self.position += count;
    }
}

/// Writes into a slice until something does not fit; then it writes no more.
#[derive(Debug)]
pub(super) struct Writer<'a> {
    body: &'a mut [u8],
    position: usize,
    full: bool,
}

impl<'a> Writer<'a> {
    pub(super) const fn new(body: &'a mut [u8]) -> Self {
        Self { body, position: 0, full: false }
    }

    pub(super) const fn position(&self) -> usize {
        self.position
    }

    #[inline]
    fn next(&mut self, count: usize) -> Option<&mut [u8]> {
        let end = self.position.checked_add(count).filter(|end| !self.full && *end <= self.body.len());
        self.full = end.is_none();
        let end = end?;
        let start = std::mem::replace(&mut self.position, end);
        Some(&mut self.body[start..end])
    }
}

impl Output for Writer<'_> {
    #[inline]
    fn align(&mut self, alignment: usize) {
        // Loaned memory holds what its last user left: padding is written, too.
        let padding = self.position.next_multiple_of(alignment) - self.position;
        if let Some(space) = self.next(padding) {
            space.fill(0);
        }
    }

    #[inline]
    fn put_with(&mut self, count: usize, fill: impl FnOnce(&mut [u8])) {
        if let Some(space) = self.next(count) {
            fill(space);
        }
    }
}
