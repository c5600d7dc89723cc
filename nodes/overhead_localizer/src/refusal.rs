//! Messages that do not count: no frames, another publisher's, or of another time.

use trench_core::{FromTheFuture, NotMaster};

/// Why a message changes nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum Dropped {
    /// It is no frame of this camera.
    #[error("{0}")]
    Broken(String),
    /// It may be one, and does not count.
    #[error(transparent)]
    Refused(#[from] Refusal),
}

/// Why a frame does not count.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub(crate) enum Refusal {
    #[error(transparent)]
    NotMaster(#[from] NotMaster),
    #[error(transparent)]
    Future(#[from] FromTheFuture),
}

impl From<String> for Dropped {
    fn from(reason: String) -> Self {
        Self::Broken(reason)
    }
}
