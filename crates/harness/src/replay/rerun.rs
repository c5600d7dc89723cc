//! The replay itself: no processes, no waiting.

use super::compare::Comparison;
use super::difference::{Changes, Difference};
use crate::catalog;
use std::path::Path;
use trench_config::ConfigError;
use trench_core::arguments::Names;
use trench_core::{NodeCore, NodeDescription, StartError, Steady, Times};
use trench_journal::{
    Input, Journal, JournalError, JournalReader, Parameter, Ports, Record, RecordedFiles, Start, Step, Witness,
};

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
        error: StartError,
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
    /// All outputs are the same.
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

/// Replays a journal.
///
/// # Errors
/// When the file is no journal or of a node that this program does not have.
pub fn replay(journal: &JournalReader) -> Result<Report, ReplayError> {
    replay_from(journal, journal.start())
}

/// Replays a journal through a core made from `start` instead of the journal's own beginning: what would have changed
/// with another gain.
///
/// # Errors
/// As [`replay`].
pub fn replay_from(journal: &JournalReader, start: &Start) -> Result<Report, ReplayError> {
    let description = described(start)?;
    let mut comparison = Comparison::new(start);
    let core = match make(&description, start) {
        Ok(core) => core,
        Err(error) => return Ok(comparison.refusal(&error)),
    };
    let now = Ports::of(core.interface(), &Names::new(&[], &start.name));
    comparison.interface(&start.ports, &now);
    let mut rerun = Rerun { description, core: Witness::new(core), outputs: Vec::new() };
    for step in journal.steps() {
        let step = match step {
            Ok(step) => step,
            Err(stop) => return Ok(comparison.stopped(stop.reason)),
        };
        comparison.at(step.at);
        let mut records = step.records();
        let Some(Record::Input(input)) = records.next() else { continue };
        if let Err(reason) = rerun.feed(step.at, &input, start) {
            return Ok(comparison.stopped(reason));
        }
        comparison.step(records, &rerun.outputs);
    }
    Ok(comparison.finish())
}

/// Writes the journal anew with the outputs that the core gives now, into `to`.
///
/// # Errors
/// When the journal cannot be followed to its end, or `to` cannot be written.
pub fn update(journal: &JournalReader, to: &Path) -> Result<(), ReplayError> {
    let recorded = journal.start();
    let description = described(recorded)?;
    let node = recorded.full_name();
    let core = make(&description, recorded).map_err(|error| ReplayError::Start { node: node.clone(), error })?;
    let start = recorded.renewed(&(description.parameters)());
    let mut written = Journal::replace(to, &start)?;
    let mut rerun = Rerun { description, core: Witness::new(core), outputs: Vec::new() };
    let mut first = None;
    let mut seconds = |at: Times| at.steady.seconds_since(*first.get_or_insert(at.steady));
    let mut from = 0.0;
    for step in journal.steps() {
        let incomplete = |reason| ReplayError::Incomplete { node: node.clone(), from, reason };
        let step: Step = step.map_err(|stop| incomplete(stop.reason))?;
        let mut records = step.records();
        let Some(Record::Input(input)) = records.next() else { continue };
        rerun.feed(step.at, &input, recorded).map_err(incomplete)?;
        written.append(step.at, step.with_outputs(&records, &rerun.outputs)).map_err(incomplete)?;
        from = seconds(step.at);
    }
    Ok(written.finish()?)
}

/// Puts a journal that [`update`] wrote into the place of the old one.
///
/// # Errors
/// When the file system refuses.
pub fn move_over(new: &Path, old: &Path) -> Result<(), ReplayError> {
    std::fs::rename(new, old).map_err(|source| JournalError::Io { path: old.to_owned(), source }.into())
}

fn described(start: &Start) -> Result<NodeDescription, ReplayError> {
    let unknown = || ReplayError::Unknown { node: start.full_name(), description: start.description.clone() };
    catalog::node(&start.description).ok_or_else(unknown)
}

fn make(description: &NodeDescription, start: &Start) -> Result<Box<dyn NodeCore>, StartError> {
    let parameters = start.parameters(&(description.parameters)());
    (description.build)(&start.context(), &parameters, &RecordedFiles(&start.files))
}

/// A core being fed.
struct Rerun {
    description: NodeDescription,
    core: Witness,
    /// Of the last step.
    outputs: Vec<u8>,
}

impl Rerun {
    /// Feeds one input, or says why that is not possible.
    fn feed(&mut self, at: Times, input: &Input<'_>, start: &Start) -> Result<(), String> {
        self.outputs.clear();
        if let Some(event) = input.event() {
            self.core.handle(at, event, None, &mut self.outputs);
            return Ok(());
        }
        match input {
            Input::SetParameters(values) => {
                // The outcome stands among the outputs.
                let _outcome: Result<(), ConfigError> = self.change(values, start);
                Ok(())
            }
            Input::Message { port, .. } => {
                let topic = start.ports.subscriptions.get(*port).map_or("a topic", |port| &port.name);
                Err(format!("{topic}: images were not journalled; record with --journal=images"))
            }
            _ => Err("an input is not understood".to_owned()),
        }
    }

    fn change(&mut self, values: &[Parameter], start: &Start) -> Result<(), ConfigError> {
        let declared = (self.description.parameters)();
        let parameters = Start { parameters: values.to_vec(), ..start.clone() }.parameters(&declared);
        self.core.set_parameters(&parameters, &mut self.outputs)
    }
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
