//! What comes of a replay.

use super::difference::{Changes, Difference};
use trench_core::{StartError, Steady, Times};
use trench_journal::JournalError;

/// Why a journal cannot be replayed at all.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// The file cannot be read or written.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// This program has no such node.
    #[error("{node} is a {description}, which is no node of this program")]
    Unknown {
        /// Its full name.
        node: String,
        /// What it was.
        description: String,
    },
    /// The journal stops where a new one cannot be made from it.
    #[error("{node}: not replayable from {from:.3} s: {reason}; the journal stays as it was")]
    Incomplete {
        /// Its full name.
        node: String,
        /// Since the first event, s.
        from: f64,
        /// What is missing.
        reason: String,
    },
    /// The node refuses to start with the recorded configuration.
    #[error("{node} does not start any more: {error}")]
    Start {
        /// Its full name.
        node: String,
        /// Why.
        error: Box<StartError>,
    },
}

/// What came of a replay.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// The node's full name.
    pub node: String,
    /// Events that the core was fed.
    pub events: u64,
    /// Outputs that the journal holds for them.
    pub outputs: u64,
    /// Outputs that were the same, bit for bit, before the first that was not.
    pub equal: u64,
    /// Outputs before the first that was not, whose differences a tolerance allows.
    pub tolerated: u64,
    /// From the first event to the last, s.
    pub seconds: f64,
    /// The outcome.
    pub verdict: Verdict,
    /// What differs in all, output by output.
    pub changes: Changes,
}

/// The outcome of a replay.
#[derive(Debug, Clone, PartialEq)]
pub enum Verdict {
    /// All outputs are the same, or as near as tolerances ask for.
    Equal,
    /// Not all; the first that is not.
    Differs(Box<Difference>),
    /// All are the same as far as the journal can be followed.
    NotReplayable {
        /// Since the first event, s.
        from: f64,
        /// What is missing.
        reason: String,
    },
}

/// Seconds from the first event on.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Elapsed {
    first: Option<Steady>,
    last: Times,
}

impl Elapsed {
    pub(super) fn at(&mut self, at: Times) {
        self.first.get_or_insert(at.steady);
        self.last = at;
    }

    pub(super) fn seconds(self) -> f64 {
        self.first.map_or(0.0, |first| self.last.steady.seconds_since(first))
    }

    pub(super) fn times(self) -> Times {
        self.last
    }
}
