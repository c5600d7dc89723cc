//! Frames from a stream of bytes, however the line cut it and whatever it did to it.

use crate::framing::{self, DELIMITER, MAX_STUFFED};
use crate::{ErrorCounts, LinkError, LinkFrame};

/// Collects bytes up to the delimiter. Never fails for good: after any garbage the next delimiter puts it in step.
#[derive(Debug, Clone)]
pub struct StreamDecoder {
    buffer: [u8; MAX_STUFFED],
    length: usize,
    overlong: bool,
    frames: u64,
    errors: ErrorCounts,
}

impl Default for StreamDecoder {
    fn default() -> Self {
        Self { buffer: [0; MAX_STUFFED], length: 0, overlong: false, frames: 0, errors: ErrorCounts::default() }
    }
}

impl StreamDecoder {
    /// Takes bytes and hands over each frame that they complete. Broken frames are counted and dropped.
    pub fn push(&mut self, bytes: &[u8], mut on_frame: impl FnMut(LinkFrame<'_>)) {
        for &byte in bytes {
            if byte != DELIMITER {
                self.collect(byte);
                continue;
            }
            match self.take() {
                Ok(None) => {}
                Ok(Some(stuffed)) => {
                    let body = framing::unframe(&mut self.buffer[..stuffed]);
                    match body.and_then(LinkFrame::decode) {
                        Ok(frame) => {
                            self.frames += 1;
                            on_frame(frame);
                        }
                        Err(error) => self.errors.count(error.name()),
                    }
                }
                Err(error) => self.errors.count(error.name()),
            }
        }
    }

    /// Forgets a frame begun: the line broke.
    pub fn reset(&mut self) {
        self.length = 0;
        self.overlong = false;
    }

    /// Good frames so far.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Errors so far, by kind.
    #[must_use]
    pub fn errors(&self) -> &ErrorCounts {
        &self.errors
    }

    fn collect(&mut self, byte: u8) {
        match self.buffer.get_mut(self.length) {
            Some(slot) => {
                *slot = byte;
                self.length += 1;
            }
            None => self.overlong = true,
        }
    }

    /// The number of bytes collected, if any, and begins anew.
    fn take(&mut self) -> Result<Option<usize>, LinkError> {
        let (length, overlong) = (self.length, self.overlong);
        self.reset();
        match (overlong, length) {
            (true, _) => Err(LinkError::Overlong),
            // Delimiters in a row separate nothing: a sender may begin with one to end old garbage.
            (false, 0) => Ok(None),
            (false, length) => Ok(Some(length)),
        }
    }
}
