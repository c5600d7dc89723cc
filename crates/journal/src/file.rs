//! The file of a journal.

use crate::JournalError;
use crate::make::Pace;
use crate::record::{End, Record};
use crate::start::Start;
use mcap::records::MessageHeader;
use mcap::write::NoSeek;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use trench_core::Times;

/// The version of what stands in the container.
pub(crate) const FORMAT: u32 = 2;
/// The channel that all is on.
pub(crate) const CHANNEL: &str = "steps";

/// A chunk is closed when it holds this many bytes ...
const CHUNK_BYTES: usize = 1 << 20;
/// ... or, where time is real, when its first step is this old: what `kill -9` can cost.
const FLUSH_AFTER: Duration = Duration::from_millis(500);

/// Takes steps and writes them chunk by chunk.
pub(crate) struct JournalFile {
    path: PathBuf,
    mcap: mcap::Writer<NoSeek<BufWriter<File>>>,
    channel: u16,
    /// Steps so far; the start is number 0.
    count: u32,
    pending_bytes: usize,
    pending_since: Option<Instant>,
    last: Times,
}

impl JournalFile {
    /// Makes `<folder>/<name>.mcap`, or `<name>.2.mcap` and so on where a node was started again.
    pub(crate) fn create(folder: &Path, name: &str, start: &Start, pace: Pace) -> Result<Self, JournalError> {
        fs::create_dir_all(folder).map_err(JournalError::io(folder))?;
        let (path, file) = new_file(folder, name)?;
        Self::over(path, file, start, pace)
    }

    /// Replaces the file at `path` by a new journal.
    pub(crate) fn replace(path: &Path, start: &Start) -> Result<Self, JournalError> {
        let file = File::create(path).map_err(JournalError::io(path))?;
        Self::over(path.to_owned(), file, start, Pace::LockStep)
    }

    fn over(path: PathBuf, file: File, start: &Start, pace: Pace) -> Result<Self, JournalError> {
        let level = pace.compression_level(start.keeps_large);
        let made = mcap::WriteOptions::new()
            .profile("trench_journal")
            .library(concat!("trench ", env!("CARGO_PKG_VERSION")))
            .compression(level.map(|_| mcap::Compression::Zstd))
            .compression_level(level.unwrap_or_default())
            .compression_threads(0)
            // Chunks end where `flush` is called and nowhere else.
            .chunk_size(None)
            .disable_seeking(true)
            .emit_message_indexes(false)
            .create(NoSeek::new(BufWriter::with_capacity(CHUNK_BYTES, file)))
            .and_then(|mut mcap| {
                let channel = mcap.add_channel(0, CHANNEL, "postcard", &BTreeMap::new())?;
                Ok((mcap, channel))
            });
        let (mcap, channel) = made.map_err(JournalError::container(&path))?;
        let last = Times::default();
        let mut file = Self { path, mcap, channel, count: 0, pending_bytes: 0, pending_since: None, last };
        let encoded = postcard::to_extend(&(FORMAT, start), Vec::new());
        let encoded = encoded.map_err(|error| JournalError::io(&file.path)(io::Error::other(error)))?;
        file.append(Times::default(), &encoded)?;
        file.flush()?;
        Ok(file)
    }

    /// Adds a step.
    pub(crate) fn append(&mut self, at: Times, step: &[u8]) -> Result<(), JournalError> {
        let header = MessageHeader {
            channel_id: self.channel,
            sequence: self.count,
            log_time: at.steady.0,
            publish_time: at.ros.0.cast_unsigned(),
        };
        self.mcap.write_to_known_channel(&header, step).map_err(JournalError::container(&self.path))?;
        self.count = self.count.wrapping_add(1);
        self.last = at;
        self.pending_bytes += step.len();
        self.pending_since.get_or_insert_with(Instant::now);
        if self.pending_bytes >= CHUNK_BYTES { self.flush() } else { Ok(()) }
    }

    /// Closes the open chunk if its first step is old.
    pub(crate) fn flush_if_due(&mut self) -> Result<(), JournalError> {
        match self.pending_since {
            Some(since) if since.elapsed() >= FLUSH_AFTER => self.flush(),
            _ => Ok(()),
        }
    }

    fn flush(&mut self) -> Result<(), JournalError> {
        self.mcap.flush().map_err(JournalError::container(&self.path))?;
        (self.pending_bytes, self.pending_since) = (0, None);
        Ok(())
    }

    /// Writes the last record and the summary.
    pub(crate) fn finish(mut self, end: End) -> Result<(), JournalError> {
        let mut record = Vec::new();
        Record::End(end).append_to(&mut record);
        self.append(self.last, &record)?;
        self.mcap.finish().map_err(JournalError::container(&self.path))?;
        let file = self.mcap.into_inner().into_inner();
        file.into_inner().map(drop).map_err(|error| JournalError::io(&self.path)(error.into_error()))
    }
}

fn new_file(folder: &Path, name: &str) -> Result<(PathBuf, File), JournalError> {
    let mut life = 1;
    loop {
        let file_name = if life == 1 { format!("{name}.mcap") } else { format!("{name}.{life}.mcap") };
        let path = folder.join(file_name);
        match File::create_new(&path) {
            Ok(file) => return Ok((path, file)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => life += 1,
            Err(error) => return Err(JournalError::io(&path)(error)),
        }
    }
}
