//! A file that only ever grows by whole chunks.

use std::fs::File;
use std::io::{self, Write};
use std::os::unix::fs::FileExt;
use std::path::Path;

/// Collects what is written and appends it to the file in one write when flushed. A write that fails (full disk) is
/// taken back and is the last, so that the file always ends where a chunk ends: an index of what follows would point
/// beside it.
pub(super) struct ChunkFile {
    file: File,
    committed: u64,
    buffer: Vec<u8>,
    is_broken: bool,
}

impl ChunkFile {
    pub(super) fn create(path: &Path) -> io::Result<Self> {
        Ok(Self { file: File::create_new(path)?, committed: 0, buffer: Vec::new(), is_broken: false })
    }

    /// Writes what is left.
    pub(super) fn finish(mut self) -> io::Result<File> {
        self.flush()?;
        Ok(self.file)
    }
}

impl Write for ChunkFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.buffer.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.is_broken {
            self.buffer.clear();
            return Err(io::Error::other("the file ended when it could not be written"));
        }
        let written = self.file.write_all_at(&self.buffer, self.committed);
        if written.is_err() {
            self.is_broken = true;
            self.file.set_len(self.committed)?;
        } else {
            self.committed += self.buffer.len() as u64;
        }
        self.buffer.clear();
        written
    }
}
