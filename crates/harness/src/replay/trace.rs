//! How one number of a node's output went in the recording, and how it goes now.

use super::report::{Elapsed, ReplayError};
use super::rerun::{Rerun, described, make};
use super::subject::Subjects;
use trench_journal::{JournalReader, Output, Record, Records};

/// A field of a topic over time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trace {
    /// In order.
    pub samples: Vec<Sample>,
}

/// A field in two outputs that belong to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Since the first event, s.
    pub seconds: f64,
    /// What the journal says; nothing where it has no such output.
    pub recorded: Option<f64>,
    /// What the core does now; nothing where it does not.
    pub now: Option<f64>,
}

/// Follows the number at `path` in the outputs of `subject`, as far as the journal can be followed.
///
/// # Errors
/// When the journal is of a node that this program does not have, or that does not start any more.
pub fn trace(journal: &JournalReader, subject: &str, path: &str) -> Result<Trace, ReplayError> {
    let start = journal.start();
    let description = described(start)?;
    let core = make(&description, start)
        .map_err(|error| ReplayError::Start { node: start.full_name(), error: Box::new(error) })?;
    let mut rerun = Rerun::new(description, core);
    let mut subjects = Subjects::new(&start.ports);
    let (mut elapsed, mut trace) = (Elapsed::default(), Trace::default());
    for step in journal.steps().map_while(Result::ok) {
        elapsed.at(step.at);
        let mut records = step.records();
        let Some(Record::Input(input)) = records.next() else { continue };
        if rerun.feed(step.at, &input, start).is_err() {
            break;
        }
        let mut values = |records: Records<'_>| -> Vec<f64> {
            let outputs = records.filter_map(|record| match record {
                Record::Output(output) => Some(output),
                Record::Input(_) | Record::End(_) => None,
            });
            outputs.filter_map(|output: Output<'_>| subjects.value(&output, subject, path)).collect()
        };
        let (recorded, now) = (values(records), values(Records::new(&rerun.outputs)));
        for index in 0..recorded.len().max(now.len()) {
            let (recorded, now) = (recorded.get(index).copied(), now.get(index).copied());
            trace.samples.push(Sample { seconds: elapsed.seconds(), recorded, now });
        }
    }
    Ok(trace)
}
