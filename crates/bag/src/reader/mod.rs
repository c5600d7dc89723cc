//! Reading a bag.

mod chunk;
mod file;
mod order;
mod record;
mod scan;
mod summary_section;

use crate::{BagError, TopicType, metadata, qos};
use file::BagFile;
use scan::Trust;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use trench_core::Qos;

pub use order::{BagMessage, Messages};

/// A topic of a bag.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Topic {
    /// For example `/team_state`.
    pub name: String,
    /// For example `trench_msgs/msg/TeamState`.
    pub type_name: String,
    /// Its RIHS01 hash; empty where the bag does not say it.
    pub type_hash: String,
    /// The definition as the bag carries it.
    pub definition: String,
    /// The quality of service its writers offered, YAML as the bag carries it.
    pub offered_qos: String,
    /// How many intact messages the bag holds.
    pub message_count: u64,
}

impl Topic {
    /// The type, as a [`crate::BagWriter`] wants it.
    #[must_use]
    pub fn topic_type(&self) -> TopicType<'_> {
        TopicType { name: &self.type_name, hash: &self.type_hash, definition: &self.definition }
    }

    /// What all its writers together can promise: reliable, and kept for late readers, where each of them was.
    #[must_use]
    pub fn qos(&self) -> Qos {
        qos::common(&self.offered_qos)
    }
}

/// Something in a bag that is not as it was written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{path}: {what}")]
pub struct Damage {
    /// The file.
    pub path: PathBuf,
    /// What is wrong, where, and what it cost.
    pub what: String,
}

/// A bag, opened and checked from its first to its last byte.
pub struct BagReader {
    path: PathBuf,
    files: Vec<BagFile>,
    topics: Vec<Topic>,
    damage: Vec<Damage>,
    span: Option<(u64, u64)>,
}

impl BagReader {
    /// Opens a bag's folder, or a single `.mcap` file, and checks every chunk of it. A folder without `metadata.yaml`
    /// (its recorder was killed) is read by its `.mcap` files in the order of their numbers. A file that has an intact
    /// summary and whose data agree with their checksum is taken at its word.
    ///
    /// # Errors
    /// When there is no bag at `path`. Damage inside the files is no error: see [`BagReader::damage`].
    pub fn open(path: &Path) -> Result<Self, BagError> {
        Self::read(path, Trust::Checksum)
    }

    /// As [`BagReader::open`], but takes no file at its word: looks into every chunk.
    ///
    /// # Errors
    /// When there is no bag at `path`.
    pub fn examine(path: &Path) -> Result<Self, BagError> {
        Self::read(path, Trust::Nothing)
    }

    fn read(path: &Path, trust: Trust) -> Result<Self, BagError> {
        let mut reader =
            Self { path: path.to_owned(), files: Vec::new(), topics: Vec::new(), damage: Vec::new(), span: None };
        for file in files_of(path)? {
            let scanned = scan::scan(&file, trust, &mut reader.topics)?;
            reader.damage.extend(scanned.damage.into_iter().map(|what| Damage { path: file.clone(), what }));
            for block in &scanned.file.blocks {
                let (first, last) = reader.span.unwrap_or((block.first, block.last));
                reader.span = Some((first.min(block.first), last.max(block.last)));
            }
            reader.files.push(scanned.file);
        }
        Ok(reader)
    }

    /// Where the bag is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its topics, in the order in which the files name them.
    #[must_use]
    pub fn topics(&self) -> &[Topic] {
        &self.topics
    }

    /// The index of a topic.
    #[must_use]
    pub fn topic(&self, name: &str) -> Option<usize> {
        self.topics.iter().position(|topic| topic.name == name)
    }

    /// What is not intact. Empty for a bag that is as it was written.
    #[must_use]
    pub fn damage(&self) -> &[Damage] {
        &self.damage
    }

    /// First and last log time, ns; nothing for a bag without messages.
    #[must_use]
    pub fn span(&self) -> Option<(u64, u64)> {
        self.span
    }

    /// How many intact messages it holds.
    #[must_use]
    pub fn message_count(&self) -> u64 {
        self.topics.iter().map(|topic| topic.message_count).sum()
    }

    /// The length of the longest message of each topic, bytes, in the order of [`BagReader::topics`]. Reads the whole bag.
    ///
    /// # Errors
    /// When a file cannot be read to its end.
    pub fn longest(&self) -> Result<Vec<usize>, BagError> {
        let mut longest = vec![0; self.topics.len()];
        for message in self.messages() {
            let message = message?;
            if let Some(length) = longest.get_mut(message.topic) {
                *length = message.len().max(*length);
            }
        }
        Ok(longest)
    }

    /// The names of its files and their sizes in bytes.
    pub fn files(&self) -> impl Iterator<Item = (&Path, u64)> {
        self.files.iter().map(|file| (file.path.as_path(), file.length))
    }

    /// All intact messages of all files in the order of their log times; of equal times in the order of writing.
    #[must_use]
    pub fn messages(&self) -> Messages<&Self> {
        Messages::new(self, 0)
    }

    /// As [`BagReader::messages`] of a shared bag, from those on that were logged at `from` (ns).
    #[must_use]
    pub fn messages_from(self: &Arc<Self>, from: u64) -> Messages<Arc<Self>> {
        Messages::new(Arc::clone(self), from)
    }
}

fn files_of(path: &Path) -> Result<Vec<PathBuf>, BagError> {
    let kind = fs::metadata(path).map_err(BagError::io(path))?;
    if kind.is_file() {
        return Ok(vec![path.to_owned()]);
    }
    let description = path.join(metadata::FILE_NAME);
    let mut files = match fs::read_to_string(&description) {
        // Only the last part of a name counts: bags move, and none may point outside its folder.
        Ok(text) => metadata::file_names(&description, &text)?
            .iter()
            .filter_map(|name| Path::new(name).file_name().map(|name| path.join(name)))
            .collect(),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => mcap_files(path)?,
        Err(error) => return Err(BagError::io(&description)(error)),
    };
    files.dedup();
    if files.is_empty() { Err(BagError::NoFiles(path.to_owned())) } else { Ok(files) }
}

fn mcap_files(folder: &Path) -> Result<Vec<PathBuf>, BagError> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(BagError::io(folder))? {
        let path = entry.map_err(BagError::io(folder))?.path();
        if path.extension().is_some_and(|extension| extension == "mcap") {
            files.push(path);
        }
    }
    files.sort_by_cached_key(|path| written_order(path));
    Ok(files)
}

/// Files of a split bag in the order in which they were written: number 10 behind number 9.
fn written_order(path: &Path) -> (String, u64, PathBuf) {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let number = stem.rsplit_once('_').and_then(|(name, number)| Some((name, number.parse().ok()?)));
    let (name, number) = number.unwrap_or((&stem, 0));
    (name.to_owned(), number, path.to_owned())
}
