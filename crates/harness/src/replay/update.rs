//! Journals after an intended change of behaviour.

use super::report::ReplayError;
use super::rerun::{Rerun, described, make};
use std::path::Path;
use trench_core::Times;
use trench_journal::{Journal, JournalError, JournalReader, Record, Step};

/// Writes the journal anew with the outputs that the core gives now, into `to`.
///
/// # Errors
/// When the journal cannot be followed to its end, or `to` cannot be written.
pub fn update(journal: &JournalReader, to: &Path) -> Result<(), ReplayError> {
    let recorded = journal.start();
    let description = described(recorded)?;
    let node = recorded.full_name();
    let core = make(&description, recorded)
        .map_err(|error| ReplayError::Start { node: node.clone(), error: Box::new(error) })?;
    let start = recorded.renewed(&(description.parameters)());
    let mut written = Journal::replace(to, &start)?;
    let mut rerun = Rerun::new(description, core);
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
