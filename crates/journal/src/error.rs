//! Why a journal cannot be written or read.

use std::path::{Path, PathBuf};
use trench_bag::BagError;

/// What stops a journal from being written or read.
#[derive(Debug, thiserror::Error)]
pub enum JournalError {
    /// A file or folder cannot be read or written.
    #[error("{path}: {source}")]
    Io {
        /// Which one.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The container refused a record.
    #[error("{path}: {source}")]
    Container {
        /// The journal.
        path: PathBuf,
        /// What it said.
        source: mcap::McapError,
    },
    /// The container cannot be read.
    #[error(transparent)]
    Bag(#[from] BagError),
    /// The file is something else, or its beginning is lost.
    #[error("{path} is no journal, or its beginning is lost: {problem}")]
    NoStart {
        /// The file.
        path: PathBuf,
        /// What is missing.
        problem: String,
    },
    /// The journal is of another version of the format.
    #[error("{path} has format {found}, this program reads format {known}; record the run again")]
    Format {
        /// The file.
        path: PathBuf,
        /// Its format.
        found: u32,
        /// Ours.
        known: u32,
    },
}

impl JournalError {
    /// An I/O error of `path`, for `map_err`.
    pub(crate) fn io(path: &Path) -> impl FnOnce(std::io::Error) -> Self + '_ {
        |source| Self::Io { path: path.to_owned(), source }
    }

    /// An error of the container at `path`, for `map_err`.
    pub(crate) fn container(path: &Path) -> impl FnOnce(mcap::McapError) -> Self + '_ {
        |source| match source {
            mcap::McapError::Io(source) => Self::Io { path: path.to_owned(), source },
            source => Self::Container { path: path.to_owned(), source },
        }
    }
}
