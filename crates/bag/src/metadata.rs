//! `metadata.yaml`, the part of a bag that names its files and counts its messages (format 9).

use crate::qos::OfferedQos;
use crate::{BagError, TopicType};
use serde::{Deserialize, Serialize};
use std::path::Path;
use trench_core::Qos;

/// The file's name in the bag's folder.
pub(crate) const FILE_NAME: &str = "metadata.yaml";

/// The document that `metadata.yaml` holds.
#[derive(Serialize)]
pub(crate) struct Document<'a> {
    pub(crate) rosbag2_bagfile_information: &'a Metadata,
}

/// What a bag, or one file of it, says of itself.
#[derive(Serialize)]
pub(crate) struct Metadata {
    version: u32,
    storage_identifier: &'static str,
    duration: Duration,
    starting_time: StartingTime,
    message_count: u64,
    topics_with_message_count: Vec<CountedTopic>,
    compression_format: &'static str,
    compression_mode: &'static str,
    relative_file_paths: Vec<String>,
    files: Vec<FileInformation>,
    custom_data: Option<()>,
    ros_distro: &'static str,
}

#[derive(Serialize, Clone, Copy)]
struct Duration {
    nanoseconds: u64,
}

#[derive(Serialize, Clone, Copy)]
struct StartingTime {
    nanoseconds_since_epoch: u64,
}

/// One file of a bag and what it holds.
#[derive(Serialize, Clone)]
pub(crate) struct FileInformation {
    path: String,
    starting_time: StartingTime,
    duration: Duration,
    message_count: u64,
}

impl FileInformation {
    /// Of a file with messages from the first to the last time of `span` (ns).
    pub(crate) fn new(path: &str, span: Option<(u64, u64)>, message_count: u64) -> Self {
        let (first, last) = span.unwrap_or_default();
        Self {
            path: path.to_owned(),
            starting_time: StartingTime { nanoseconds_since_epoch: first },
            duration: Duration { nanoseconds: last.saturating_sub(first) },
            message_count,
        }
    }
}

/// A topic and how many of its messages the bag holds.
#[derive(Serialize, Clone)]
pub(crate) struct CountedTopic {
    topic_metadata: TopicMetadata,
    pub(crate) message_count: u64,
}

#[derive(Serialize, Clone)]
struct TopicMetadata {
    name: String,
    r#type: String,
    serialization_format: &'static str,
    offered_qos_profiles: Vec<OfferedQos>,
    type_description_hash: String,
}

impl CountedTopic {
    pub(crate) fn new(name: &str, topic_type: TopicType<'_>, qos: Qos) -> Self {
        Self {
            topic_metadata: TopicMetadata {
                name: name.to_owned(),
                r#type: topic_type.name.to_owned(),
                serialization_format: "cdr",
                offered_qos_profiles: vec![qos.into()],
                type_description_hash: topic_type.hash.to_owned(),
            },
            message_count: 0,
        }
    }
}

impl Metadata {
    /// Of these files, with messages from the first to the last time of `span` (ns).
    pub(crate) fn new(files: Vec<FileInformation>, topics: &[CountedTopic], span: Option<(u64, u64)>) -> Self {
        let (first, last) = span.unwrap_or_default();
        Self {
            version: 9,
            storage_identifier: "mcap",
            duration: Duration { nanoseconds: last.saturating_sub(first) },
            starting_time: StartingTime { nanoseconds_since_epoch: first },
            message_count: topics.iter().map(|topic| topic.message_count).sum(),
            topics_with_message_count: topics.to_vec(),
            compression_format: "",
            compression_mode: "",
            relative_file_paths: files.iter().map(|file| file.path.clone()).collect(),
            files,
            custom_data: None,
            ros_distro: "kilted",
        }
    }
}

/// The part of anybody's `metadata.yaml` that a reader needs: everything else is in the files.
#[derive(Deserialize)]
struct FileList {
    rosbag2_bagfile_information: Information,
}

#[derive(Deserialize)]
struct Information {
    relative_file_paths: Vec<String>,
    #[serde(default)]
    storage_identifier: String,
    #[serde(default)]
    compression_mode: String,
}

/// The names of a bag's files, in order, from the text of its `metadata.yaml` at `path`.
pub(crate) fn file_names(path: &Path, text: &str) -> Result<Vec<String>, BagError> {
    let wrong = |problem: String| BagError::Metadata { path: path.to_owned(), problem };
    let list: FileList = serde_saphyr::from_str(text).map_err(|error| wrong(error.to_string()))?;
    let information = list.rosbag2_bagfile_information;
    if information.storage_identifier != "mcap" {
        return Err(wrong(format!("storage {:?} cannot be read, only mcap", information.storage_identifier)));
    }
    if !matches!(information.compression_mode.to_lowercase().as_str(), "" | "none") {
        return Err(wrong(format!(
            "compression_mode {:?} cannot be read, only chunks compressed inside the MCAP file",
            information.compression_mode
        )));
    }
    Ok(information.relative_file_paths)
}
