//! Writing a bag.

mod chunk_file;
mod disk;

use crate::metadata::{self, CountedTopic, Document, Metadata};
use crate::{BagError, TopicType};
use chunk_file::ChunkFile;
use mcap::records::MessageHeader;
use mcap::write::{Metadata as MetadataRecord, NoSeek};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use trench_core::Qos;

/// How a bag is written.
#[derive(Debug, Clone, Copy)]
pub struct WriteOptions {
    /// A chunk is closed when it holds this many bytes.
    pub chunk_bytes: u64,
    /// ... or when its first message is this old: what a killed recorder can lose.
    pub flush_after: Duration,
    /// Recording stops when the disk has no more than this left, besides what the index needs.
    pub disk_reserve: u64,
}

impl Default for WriteOptions {
    fn default() -> Self {
        Self { chunk_bytes: 1 << 20, flush_after: Duration::from_millis(500), disk_reserve: 4 << 20 }
    }
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

/// Writes a bag: a folder with one `.mcap` file and `metadata.yaml`.
///
/// Whole chunks reach the file in one write each, so that a killed process leaves a file that ends at a chunk.
pub struct BagWriter {
    directory: PathBuf,
    file_name: String,
    options: WriteOptions,
    mcap: mcap::Writer<NoSeek<ChunkFile>>,
    topics: Vec<CountedTopic>,
    channels: Vec<u16>,
    ids: BTreeMap<(String, String), TopicId>,
    /// First and last log time.
    span: Option<(u64, u64)>,
    pending_bytes: u64,
    pending_since: Option<Instant>,
    index_bytes: u64,
    full: Option<(u64, u64)>,
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
        let name = directory.file_name().map_or_else(|| "bag".into(), |name| name.to_string_lossy());
        let file_name = format!("{name}_0.mcap");
        let file = ChunkFile::create(&directory.join(&file_name)).map_err(BagError::io(directory))?;
        let mcap = mcap::WriteOptions::new()
            .profile("ros2")
            .library(concat!("trench ", env!("CARGO_PKG_VERSION")))
            .compression(Some(mcap::Compression::Zstd))
            // Level 1: the recorder shares its processor with the robots' controllers.
            .compression_level(1)
            .compression_threads(0)
            // Chunks end where `flush` is called and nowhere else.
            .chunk_size(None)
            .disable_seeking(true)
            .create(NoSeek::new(file))
            .map_err(BagError::mcap(directory))?;
        let mut writer = Self {
            directory: directory.to_owned(),
            file_name,
            options,
            mcap,
            topics: Vec::new(),
            channels: Vec::new(),
            ids: BTreeMap::new(),
            span: None,
            pending_bytes: 0,
            pending_since: None,
            index_bytes: 4096,
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
        let offered = self.yaml(&[crate::qos::OfferedQos::from(qos)])?;
        let metadata = BTreeMap::from([
            ("offered_qos_profiles".to_owned(), offered),
            ("topic_type_hash".to_owned(), topic_type.hash.to_owned()),
        ]);
        // An encoding says that there is a definition.
        let encoding = if topic_type.definition.is_empty() { "" } else { "ros2msg" };
        let schema = self.mcap.add_schema(topic_type.name, encoding, topic_type.definition.as_bytes());
        let channel = schema.and_then(|schema| self.mcap.add_channel(schema, name, "cdr", &metadata));
        self.channels.push(channel.map_err(BagError::mcap(&self.directory))?);
        self.topics.push(CountedTopic::new(name, topic_type, qos));
        let id = TopicId(self.topics.len() - 1);
        self.ids.insert(key, id);
        // Schema and channel stand in the chunk and again in the summary; metadata.yaml repeats the rest.
        self.index_bytes += topic_type.definition.len() as u64 + 4096;
        Ok(id)
    }

    /// Writes one message, CDR with its encapsulation header.
    ///
    /// # Errors
    /// When the disk is full or the file cannot be written. Every later call then fails in the same way, except
    /// [`BagWriter::finish`].
    pub fn write(&mut self, topic: TopicId, stamp: Stamp, cdr: &[u8]) -> Result<(), BagError> {
        self.check_open()?;
        let (Some(&channel_id), Some(counted)) = (self.channels.get(topic.0), self.topics.get_mut(topic.0)) else {
            return Ok(()); // An id of another writer: there is nothing it could name here.
        };
        let Stamp { log_time, publish_time, sequence } = stamp;
        let header = MessageHeader { channel_id, sequence, log_time, publish_time };
        self.mcap.write_to_known_channel(&header, cdr).map_err(BagError::mcap(&self.directory))?;
        counted.message_count += 1;
        let (first, last) = self.span.unwrap_or((log_time, log_time));
        self.span = Some((first.min(log_time), last.max(log_time)));
        self.pending_bytes += cdr.len() as u64 + 31;
        let since = *self.pending_since.get_or_insert_with(Instant::now);
        if self.pending_bytes >= self.options.chunk_bytes || since.elapsed() >= self.options.flush_after {
            self.flush()?;
        }
        Ok(())
    }

    /// Closes the open chunk if its first message is older than [`WriteOptions::flush_after`]. To be called several
    /// times a second while no messages come.
    ///
    /// # Errors
    /// As [`BagWriter::write`].
    pub fn flush_if_due(&mut self) -> Result<(), BagError> {
        match self.pending_since {
            Some(since) if since.elapsed() >= self.options.flush_after => self.flush(),
            _ => Ok(()),
        }
    }

    /// Closes the open chunk and hands it to the system: it survives the death of this process.
    ///
    /// # Errors
    /// As [`BagWriter::write`].
    pub fn flush(&mut self) -> Result<(), BagError> {
        self.check_open()?;
        self.mcap.flush().map_err(BagError::mcap(&self.directory))?;
        self.pending_bytes = 0;
        self.pending_since = None;
        self.index_bytes += 64 + 18 * self.topics.len() as u64;
        let needed = self.options.disk_reserve.saturating_add(2 * self.index_bytes);
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
        self.topics.iter().map(|topic| topic.message_count).sum()
    }

    /// Writes summary and `metadata.yaml`.
    ///
    /// # Errors
    /// When the disk cannot take them: what was flushed before is readable nevertheless.
    pub fn finish(mut self) -> Result<(), BagError> {
        let (first, last) = self.span.unwrap_or((0, 0));
        let metadata = Metadata::new(&self.file_name, &self.topics, first, last);
        let record = MetadataRecord {
            name: "rosbag2".to_owned(),
            metadata: BTreeMap::from([("serialized_metadata".to_owned(), self.yaml(&metadata)?)]),
        };
        let mcap = self.mcap.write_metadata(&record).and_then(|()| self.mcap.finish());
        mcap.map_err(BagError::mcap(&self.directory))?;
        let file = self.mcap.into_inner().into_inner();
        file.finish().map_err(BagError::io(&self.directory))?;
        let text = serde_saphyr::to_string(&Document { rosbag2_bagfile_information: &metadata });
        let text = text.map_err(|error| metadata_error(&self.directory, &error))?;
        let path = self.directory.join(metadata::FILE_NAME);
        // Renamed into place: a reader never sees half of it.
        let partial = path.with_extension("yaml.partial");
        fs::write(&partial, text).map_err(BagError::io(&partial))?;
        fs::rename(&partial, &path).map_err(BagError::io(&path))
    }

    fn check_open(&self) -> Result<(), BagError> {
        match self.full {
            Some((available, needed)) => Err(BagError::DiskFull { path: self.directory.clone(), available, needed }),
            None => Ok(()),
        }
    }

    fn yaml(&self, value: &impl serde::Serialize) -> Result<String, BagError> {
        serde_saphyr::to_string(value).map_err(|error| metadata_error(&self.directory, &error))
    }
}

fn metadata_error(directory: &Path, error: &dyn std::fmt::Display) -> BagError {
    BagError::Metadata { path: directory.join(metadata::FILE_NAME), problem: error.to_string() }
}
