//! The replay itself: no processes, no waiting.

use super::compare::Comparison;
use super::report::{ReplayError, Report};
use super::tolerance::Tolerances;
use crate::catalog;
use trench_config::ConfigError;
use trench_core::arguments::Names;
use trench_core::{NodeCore, NodeDescription, StartError, Times};
use trench_journal::{Input, JournalReader, Parameter, Ports, Record, RecordedFiles, Start, Witness};

/// Replays a journal.
///
/// # Errors
/// When the file is no journal or of a node that this program does not have.
pub fn replay(journal: &JournalReader) -> Result<Report, ReplayError> {
    replay_from(journal, journal.start())
}

/// Replays a journal; numbers may differ by as much as `tolerances` allow.
///
/// # Errors
/// As [`replay`].
pub fn replay_within(journal: &JournalReader, tolerances: &Tolerances) -> Result<Report, ReplayError> {
    run(journal, journal.start(), tolerances)
}

/// Replays a journal through a core made from `start` instead of the journal's own beginning: what would have changed
/// with another gain.
///
/// # Errors
/// As [`replay`].
pub fn replay_from(journal: &JournalReader, start: &Start) -> Result<Report, ReplayError> {
    run(journal, start, &Tolerances::default())
}

fn run(journal: &JournalReader, start: &Start, tolerances: &Tolerances) -> Result<Report, ReplayError> {
    let description = described(start)?;
    let mut comparison = Comparison::new(start, tolerances);
    let core = match make(&description, start) {
        Ok(core) => core,
        Err(error) => return Ok(comparison.refusal(&error)),
    };
    let now = Ports::of(core.interface(), &Names::new(&[], &start.name));
    comparison.interface(&start.ports, &now);
    let mut rerun = Rerun::new(description, core);
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

pub(super) fn described(start: &Start) -> Result<NodeDescription, ReplayError> {
    let unknown = || ReplayError::Unknown { node: start.full_name(), description: start.description.clone() };
    catalog::node(&start.description).ok_or_else(unknown)
}

pub(super) fn make(description: &NodeDescription, start: &Start) -> Result<Box<dyn NodeCore>, StartError> {
    let parameters = start.parameters(&(description.parameters)());
    (description.build)(&start.context(), &parameters, &RecordedFiles(&start.files))
}

/// A core being fed.
pub(super) struct Rerun {
    description: NodeDescription,
    core: Witness,
    /// Of the last step.
    pub(super) outputs: Vec<u8>,
}

impl Rerun {
    pub(super) fn new(description: NodeDescription, core: Box<dyn NodeCore>) -> Self {
        Self { description, core: Witness::new(core), outputs: Vec::new() }
    }

    /// Feeds one input, or says why that is not possible.
    pub(super) fn feed(&mut self, at: Times, input: &Input<'_>, start: &Start) -> Result<(), String> {
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
