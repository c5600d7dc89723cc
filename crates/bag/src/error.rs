//! Why a bag cannot be written or read.

use std::path::{Path, PathBuf};

/// What stops a bag from being written or read. Damage inside a bag is no error but part of
/// [`crate::BagReader::damage`]: what is intact is still given.
#[derive(Debug, thiserror::Error)]
pub enum BagError {
    /// The folder of a new bag exists already.
    #[error("{0} exists already; give the bag another name or remove it")]
    Exists(PathBuf),
    /// A file or folder cannot be read or written.
    #[error("{path}: {source}")]
    Io {
        /// Which one.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The disk is (nearly) full: recording has stopped, what was recorded before is in the bag.
    #[error(
        "{path}: the disk is full ({available} bytes left, {needed} are needed to go on); recording stopped, what was \
         recorded before is readable"
    )]
    DiskFull {
        /// The bag.
        path: PathBuf,
        /// What the file system has left.
        available: u64,
        /// What the next chunk and the bag's index need.
        needed: u64,
    },
    /// The file does not begin as an MCAP file does.
    #[error("{0} is not an MCAP file")]
    NotMcap(PathBuf),
    /// The folder holds no recording.
    #[error("{0} holds neither a metadata.yaml that names .mcap files nor an .mcap file")]
    NoFiles(PathBuf),
    /// `metadata.yaml` does not say what it should.
    #[error("{path}: {problem}")]
    Metadata {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// Chunks overlap in time so much that sorting them would take more memory than a reader should.
    #[error("{path}: chunks that overlap in time hold more than {limit} bytes, they cannot be read in log order")]
    Disorder {
        /// The file.
        path: PathBuf,
        /// The most a reader keeps.
        limit: u64,
    },
    /// A chunk that was intact when the bag was opened, or that the file's own checksum vouched for, is not.
    #[error(
        "{path}: the chunk at byte {offset} is not what the file says of it: it changed while it was being read, or was \
         written so; `trench bag recover` copies what is intact"
    )]
    Changed {
        /// The file.
        path: PathBuf,
        /// Where the chunk begins.
        offset: u64,
    },
    /// The MCAP library refused a record, for example because there are too many channels.
    #[error("{path}: {source}")]
    Mcap {
        /// The file.
        path: PathBuf,
        /// What it said.
        source: mcap::McapError,
    },
}

impl BagError {
    /// An I/O error of `path`, for `map_err`.
    pub(crate) fn io(path: &Path) -> impl FnOnce(std::io::Error) -> Self + '_ {
        |source| Self::Io { path: path.to_owned(), source }
    }

    /// An error of the MCAP library, for `map_err`.
    pub(crate) fn mcap(path: &Path) -> impl FnOnce(mcap::McapError) -> Self + '_ {
        |source| match source {
            mcap::McapError::Io(source) => Self::Io { path: path.to_owned(), source },
            source => Self::Mcap { path: path.to_owned(), source },
        }
    }
}
