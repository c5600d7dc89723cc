//! Finding the next chunk behind damage.

use super::Scan;
use crate::reader::record::{self, MAX_CHUNK_HEADER, PREFIX};
use mcap::records::op;
use std::io;

/// How much is searched at once.
const WINDOW: usize = 1 << 16;

impl Scan<'_> {
    /// The offset of the first chunk record at or after `from`, noting the damage that made the search necessary.
    pub(super) fn resync(&mut self, from: u64) -> io::Result<Option<u64>> {
        let found = self.find_chunk(from)?;
        let end = found.unwrap_or(self.file.length);
        self.is_loose_open = false;
        self.note(format!("bytes {} to {end} are no intact records", from.saturating_sub(1)));
        Ok(found)
    }

    fn find_chunk(&self, from: u64) -> io::Result<Option<u64>> {
        const CANDIDATE: usize = PREFIX + MAX_CHUNK_HEADER;
        let mut at = from;
        while at < self.file.length {
            // Windows overlap by one candidate, so that none is cut in two.
            let window = self.file.read(at, (WINDOW + CANDIDATE) as u64)?;
            for (index, _) in window.iter().enumerate().take(WINDOW).filter(|&(_, &byte)| byte == op::CHUNK) {
                let Some((_, length)) = window.get(index..).and_then(record::prefix) else { break };
                let body = window.get(index + PREFIX..).unwrap_or_default();
                let body = body.get(..MAX_CHUNK_HEADER).unwrap_or(body);
                let offset = at + index as u64;
                let fits = length <= self.file.length.saturating_sub(offset + PREFIX as u64);
                if fits && record::chunk_header(body, length).is_some() {
                    return Ok(Some(offset));
                }
            }
            at += WINDOW as u64;
        }
        Ok(None)
    }
}
