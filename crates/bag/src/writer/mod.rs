//! Writing a bag.

mod chunk_file;
mod disk;
mod part;

use crate::metadata::{self, CountedTopic, FileInformation, Metadata};
use crate::{BagError, TopicType};
use part::Part;
use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use trench_core::Qos;

/// How a bag is written.
#[derive(Debug, Clone, Copy)]
pub struct WriteOptions {
    /// A chunk is closed when it holds this many bytes.
    pub chunk_bytes: u64,
    /// ... or when its first message is this old: what a killed recorder can lose. With nothing by its size alone, so that the same messages make the same
    /// bytes however long they take to come.
    pub flush_after: Option<Duration>,
    /// How chunks are compressed.
    pub compression: Compression,
    /// Recording stops when the disk has no more than this left, besides what the index needs.
    pub disk_reserve: u64,
    /// A file ends, and the next begins, before it is larger than this, bytes; a message that is larger has a file of its
    /// own.
    pub split_bytes: Option<u64>,
    /// ... or before it holds messages that were logged so far apart.
    pub split_after: Option<Duration>,
}

impl WriteOptions {
    /// For messages that come from a file or a simulation: the same ones make the same bytes.
    pub fn reproducible() -> Self {
        Self { flush_after: None, ..Self::default() }
    }
}

impl Default for WriteOptions {
    fn default() -> Self {
        Self {
            chunk_bytes: 1 << 20,
            compression: Compression::Zstd,
            flush_after: Some(Duration::from_millis(500)),
            disk_reserve: 4 << 20,
            split_bytes: None,
            split_after: None,
        }
    }
}

/// How chunks are compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Compression {
    /// With zstd: messages of numbers shrink to a half or less.
    #[default]
    Zstd,
    /// Not at all: for images, 40 MB a second of noise that nothing shrinks to less than a half.
    Off,
}

/// Names a topic of one [`BagWriter`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TopicId(usize);

/// When a message was logged and published, and which of its writer's messages it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Stamp {
    /// Receipt at the recorder, ns since the epoch of ROS time.
    pub log_time: u64,
    /// Publication, ns; equal to `log_time` where it is not known.
    pub publish_time: u64,
    /// The writer's count, 0 where it is not known.
    pub sequence: u32,
}

/// Writes a bag: a folder with `.mcap` files, one unless it is split, and `metadata.yaml`.
///
/// Whole chunks reach the file in one write each, so that a killed process leaves a file that ends at a chunk.
pub struct BagWriter {
    directory: PathBuf,
    options: WriteOptions,
    /// The file that is written now.
    part: Part,
    /// Those before it.
    finished: Vec<FileInformation>,
    /// All topics, with the counts of the finished files.
    topics: Vec<CountedTopic>,
    declared: Vec<Declared>,
    ids: BTreeMap<(String, String), TopicId>,
    /// First and last log time of the finished files.
    span: Option<(u64, u64)>,
    pending_since: Option<Instant>,
    full: Option<(u64, u64)>,
}

/// A topic, for the files that follow.
struct Declared {
    name: String,
    type_name: String,
    hash: String,
    definition: String,
    qos: Qos,
}

impl BagWriter {
    /// Makes the folder `directory` with an empty bag.
    ///
    /// # Errors
    /// When it exists, cannot be made, or the disk is full.
    pub fn create(directory: &Path, options: WriteOptions) -> Result<Self, BagError> {
        if directory.exists() {
            return Err(BagError::Exists(directory.to_owned()));
        }
        fs::create_dir_all(directory).map_err(BagError::io(directory))?;
        let mut writer = Self {
            directory: directory.to_owned(),
            options,
            part: Part::create(file_path(directory, 0), options.compression)?,
            finished: Vec::new(),
            topics: Vec::new(),
            declared: Vec::new(),
            ids: BTreeMap::new(),
            span: None,
            pending_since: None,
            full: None,
        };
        writer.flush()?;
        Ok(writer)
    }

    /// Declares a topic; the same name and type again give the same id, with the quality of service of the first time.
    ///
    /// # Errors
    /// When the disk is full or the file cannot be written.
    pub fn add_topic(&mut self, name: &str, topic_type: TopicType<'_>, qos: Qos) -> Result<TopicId, BagError> {
        self.check_open()?;
        let key = (name.to_owned(), topic_type.name.to_owned());
        if let Some(&id) = self.ids.get(&key) {
            return Ok(id);
        }
        self.part.add_topic(name, topic_type, qos)?;
        self.topics.push(CountedTopic::new(name, topic_type, qos));
        self.declared.push(Declared {
            name: name.to_owned(),
            type_name: topic_type.name.to_owned(),
            hash: topic_type.hash.to_owned(),
            definition: topic_type.definition.to_owned(),
            qos,
        });
        let id = TopicId(self.topics.len() - 1);
        self.ids.insert(key, id);
        Ok(id)
    }

    /// Writes one message, CDR with its encapsulation header.
    ///
    /// # Errors
    /// When the disk is full or the file cannot be written. Every later call then fails in the same way, except
    /// [`BagWriter::finish`].
    pub fn write(&mut self, topic: TopicId, stamp: Stamp, cdr: &[u8]) -> Result<(), BagError> {
        self.check_open()?;
        if self.is_split_due(stamp.log_time, cdr.len()) {
            self.split()?;
        }
        if self.part.pending_bytes + cdr.len() as u64 >= self.options.chunk_bytes {
            self.check_disk(cdr.len() as u64)?;
        }
        if !self.part.write(topic, stamp, cdr)? {
            return Ok(()); // An id of another writer: there is nothing it could name here.
        }
        self.pending_since.get_or_insert_with(Instant::now);
        if self.part.pending_bytes >= self.options.chunk_bytes || self.is_flush_due() {
            self.flush()?;
        }
        Ok(())
    }

    /// Whether the open chunk's first message is as old as it may be.
    fn is_flush_due(&self) -> bool {
        let old = |after| self.pending_since.is_some_and(|since| since.elapsed() >= after);
        self.options.flush_after.is_some_and(old)
    }

    /// Whether a message belongs into the next file.
    fn is_split_due(&self, log_time: u64, length: usize) -> bool {
        let Some((first, _)) = self.part.span else { return false };
        let is_long =
            self.options.split_after.is_some_and(|after| log_time.saturating_sub(first) >= nanoseconds(after));
        is_long || self.options.split_bytes.is_some_and(|most| self.part.length_with(length) > most)
    }

    /// Ends the file and begins the next. The system writes it to the disk when it likes: nothing waits here.
    fn split(&mut self) -> Result<(), BagError> {
        self.flush()?;
        let mut next = Part::create(file_path(&self.directory, self.finished.len() + 1), self.options.compression)?;
        for Declared { name, type_name, hash, definition, qos } in &self.declared {
            next.add_topic(name, TopicType { name: type_name, hash, definition }, *qos)?;
        }
        let part = std::mem::replace(&mut self.part, next);
        self.finished.push(part.information());
        part.add_counts(&mut self.topics);
        self.span = joined(self.span, part.span);
        part.finish()?;
        self.flush()
    }

    /// Closes the open chunk if its first message is older than [`WriteOptions::flush_after`]; else looks whether the disk has
    /// room, so that a disk that others fill is noticed at once. To be called several times a second, messages or not.
    ///
    /// # Errors
    /// As [`BagWriter::write`].
    pub fn flush_if_due(&mut self) -> Result<(), BagError> {
        if self.is_flush_due() { self.flush() } else { self.check_disk(0) }
    }

    /// Closes the open chunk and hands it to the system: it survives the death of this process.
    ///
    /// # Errors
    /// As [`BagWriter::write`].
    pub fn flush(&mut self) -> Result<(), BagError> {
        self.check_open()?;
        self.pending_since = None;
        let flushed = self.part.flush();
        if let Err(BagError::Io { source, .. }) = &flushed
            && source.kind() == ErrorKind::StorageFull
        {
            // Somebody else filled the disk since the last look.
            self.full = Some((disk::available(&self.directory).unwrap_or(0), self.options.disk_reserve));
            return self.check_open();
        }
        flushed?;
        self.check_disk(0)
    }

    /// Whether the disk has room for so many bytes more, the index and the reserve.
    fn check_disk(&mut self, bytes: u64) -> Result<(), BagError> {
        let needed = self.options.disk_reserve.saturating_add(2 * self.part.index_bytes).saturating_add(bytes);
        let available = disk::available(&self.directory).map_err(BagError::io(&self.directory))?;
        if available < needed {
            self.full = Some((available, needed));
        }
        self.check_open()
    }

    /// Changes [`WriteOptions::disk_reserve`] from the next flush on.
    pub fn set_disk_reserve(&mut self, bytes: u64) {
        self.options.disk_reserve = bytes;
    }

    /// How many messages were written so far.
    #[must_use]
    pub fn message_count(&self) -> u64 {
        let finished: u64 = self.topics.iter().map(|topic| topic.message_count).sum();
        finished + self.part.message_count()
    }

    /// Writes summary and `metadata.yaml`.
    ///
    /// # Errors
    /// When the disk cannot take them: what was flushed before is readable nevertheless.
    pub fn finish(mut self) -> Result<(), BagError> {
        self.finished.push(self.part.information());
        self.part.add_counts(&mut self.topics);
        let metadata = Metadata::new(self.finished, &self.topics, joined(self.span, self.part.span));
        let file = self.part.finish()?;
        let path = self.directory.join(metadata::FILE_NAME);
        let text = part::document(&path, &metadata)?;
        // Renamed into place: a reader never sees half of it.
        let partial = path.with_extension("yaml.partial");
        fs::write(&partial, text).map_err(BagError::io(&partial))?;
        fs::rename(&partial, &path).map_err(BagError::io(&path))?;
        // Last: a busy disk can take so long that a launcher loses its patience.
        file.sync_data().map_err(BagError::io(&self.directory))
    }

    fn check_open(&self) -> Result<(), BagError> {
        match self.full {
            Some((available, needed)) => Err(BagError::DiskFull { path: self.directory.clone(), available, needed }),
            None => Ok(()),
        }
    }
}

/// The path of a bag's file by its number.
fn file_path(directory: &Path, number: usize) -> PathBuf {
    let name = directory.file_name().map_or_else(|| "bag".into(), |name| name.to_string_lossy());
    directory.join(format!("{name}_{number}.mcap"))
}

fn joined(a: Option<(u64, u64)>, b: Option<(u64, u64)>) -> Option<(u64, u64)> {
    let (Some(a), Some(b)) = (a, b) else { return a.or(b) };
    Some((a.0.min(b.0), a.1.max(b.1)))
}

fn nanoseconds(duration: Duration) -> u64 {
    u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX)
}
