//! One file of a bag being written.

use super::chunk_file::ChunkFile;
use super::{Compression, Stamp, TopicId};
use crate::metadata::{CountedTopic, Document, FileInformation, Metadata};
use crate::qos::OfferedQos;
use crate::{BagError, TopicType};
use mcap::records::MessageHeader;
use mcap::write::{Metadata as MetadataRecord, NoSeek};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use trench_core::Qos;

/// What a message takes in a chunk and in the index besides its bytes.
const PER_MESSAGE: u64 = 31 + 16;

/// A file with topics, counts and its place on the disk.
pub(super) struct Part {
    path: PathBuf,
    mcap: mcap::Writer<NoSeek<ChunkFile>>,
    channels: Vec<u16>,
    topics: Vec<CountedTopic>,
    /// First and last log time, ns.
    pub(super) span: Option<(u64, u64)>,
    /// What the open chunk holds at most, bytes.
    pub(super) pending_bytes: u64,
    /// What the index will take, roughly, bytes.
    pub(super) index_bytes: u64,
    /// What is on the disk, bytes.
    length: u64,
}

impl Part {
    pub(super) fn create(path: PathBuf, compression: Compression) -> Result<Self, BagError> {
        let file = ChunkFile::create(&path).map_err(BagError::io(&path))?;
        let mcap = mcap::WriteOptions::new()
            .profile("ros2")
            .library(concat!("trench ", env!("CARGO_PKG_VERSION")))
            .compression(match compression {
                Compression::Zstd => Some(mcap::Compression::Zstd),
                Compression::Off => None,
            })
            // Level 1: the recorder shares its processor with the robots' controllers.
            .compression_level(1)
            .compression_threads(0)
            // Chunks end where `flush` is called and nowhere else.
            .chunk_size(None)
            .disable_seeking(true)
            .create(NoSeek::new(file))
            .map_err(BagError::mcap(&path))?;
        Ok(Self {
            path,
            mcap,
            channels: Vec::new(),
            topics: Vec::new(),
            span: None,
            pending_bytes: 0,
            index_bytes: 4096,
            length: 0,
        })
    }

    /// Declares a topic; those of a bag are declared in the same order in each of its files.
    pub(super) fn add_topic(&mut self, name: &str, topic_type: TopicType<'_>, qos: Qos) -> Result<(), BagError> {
        let metadata = BTreeMap::from([
            ("offered_qos_profiles".to_owned(), self.yaml(&[OfferedQos::from(qos)])?),
            ("topic_type_hash".to_owned(), topic_type.hash.to_owned()),
        ]);
        // An encoding says that there is a definition.
        let encoding = if topic_type.definition.is_empty() { "" } else { "ros2msg" };
        let schema = self.mcap.add_schema(topic_type.name, encoding, topic_type.definition.as_bytes());
        let channel = schema.and_then(|schema| self.mcap.add_channel(schema, name, "cdr", &metadata));
        self.channels.push(channel.map_err(BagError::mcap(&self.path))?);
        self.topics.push(CountedTopic::new(name, topic_type, qos));
        // Schema and channel stand in the chunk and again in the summary; metadata.yaml repeats the rest.
        self.index_bytes += topic_type.definition.len() as u64 + 4096;
        Ok(())
    }

    /// Writes one message into the open chunk. Whether the topic is one of the bag's.
    pub(super) fn write(&mut self, topic: TopicId, stamp: Stamp, cdr: &[u8]) -> Result<bool, BagError> {
        let (Some(&channel_id), Some(counted)) = (self.channels.get(topic.0), self.topics.get_mut(topic.0)) else {
            return Ok(false);
        };
        let Stamp { log_time, publish_time, sequence } = stamp;
        let header = MessageHeader { channel_id, sequence, log_time, publish_time };
        self.mcap.write_to_known_channel(&header, cdr).map_err(BagError::mcap(&self.path))?;
        counted.message_count += 1;
        let (first, last) = self.span.unwrap_or((log_time, log_time));
        self.span = Some((first.min(log_time), last.max(log_time)));
        self.pending_bytes += cdr.len() as u64 + PER_MESSAGE;
        Ok(true)
    }

    /// Closes the open chunk and hands it to the system.
    pub(super) fn flush(&mut self) -> Result<(), BagError> {
        self.mcap.flush().map_err(BagError::mcap(&self.path))?;
        self.pending_bytes = 0;
        self.index_bytes += 64 + 18 * self.topics.len() as u64;
        self.length = fs::metadata(&self.path).map_err(BagError::io(&self.path))?.len();
        Ok(())
    }

    /// How large the file is at most when it takes a message of `length` bytes and is finished then.
    pub(super) fn length_with(&self, length: usize) -> u64 {
        self.length + self.pending_bytes + length as u64 + PER_MESSAGE + self.index_bytes
    }

    pub(super) fn message_count(&self) -> u64 {
        self.topics.iter().map(|topic| topic.message_count).sum()
    }

    /// Adds this file's counts to those of the bag.
    pub(super) fn add_counts(&self, topics: &mut [CountedTopic]) {
        for (all, own) in topics.iter_mut().zip(&self.topics) {
            all.message_count += own.message_count;
        }
    }

    /// What `metadata.yaml` says of this file.
    pub(super) fn information(&self) -> FileInformation {
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        FileInformation::new(&name, self.span, self.message_count())
    }

    /// Writes the summary and gives the file, which the system may still have in memory.
    pub(super) fn finish(mut self) -> Result<File, BagError> {
        let metadata = Metadata::new(vec![self.information()], &self.topics, self.span);
        let record = MetadataRecord {
            name: "rosbag2".to_owned(),
            metadata: BTreeMap::from([("serialized_metadata".to_owned(), self.yaml(&metadata)?)]),
        };
        let mcap = self.mcap.write_metadata(&record).and_then(|()| self.mcap.finish());
        mcap.map_err(BagError::mcap(&self.path))?;
        self.mcap.into_inner().into_inner().finish().map_err(BagError::io(&self.path))
    }

    fn yaml(&self, value: &impl serde::Serialize) -> Result<String, BagError> {
        serde_saphyr::to_string(value).map_err(|error| metadata_error(&self.path, &error))
    }
}

/// The text of a bag's `metadata.yaml`, which lies at `path`.
pub(super) fn document(path: &Path, metadata: &Metadata) -> Result<String, BagError> {
    let text = serde_saphyr::to_string(&Document { rosbag2_bagfile_information: metadata });
    text.map_err(|error| metadata_error(path, &error))
}

fn metadata_error(path: &Path, error: &dyn std::fmt::Display) -> BagError {
    BagError::Metadata { path: path.to_owned(), problem: error.to_string() }
}
