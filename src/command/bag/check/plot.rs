//! Pictures of what differs.

use super::Checked;
use crate::command::plot::diagrams;
use std::path::{Path, PathBuf};
use trench_harness::replay::{ReplayError, Trace, trace};
use trench_journal::{JournalError, JournalReader};

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub(super) enum DivergenceError {
    #[error("{}: {error}", path.display())]
    Write { path: PathBuf, error: std::io::Error },
    #[error(transparent)]
    Journal(#[from] JournalError),
    #[error(transparent)]
    Replay(#[from] ReplayError),
    #[error("{}: {problem}", path.display())]
    Drawing { path: PathBuf, problem: String },
}

/// Draws, for each topic of each node, the field that differs by most among those that differ first, and gives the
/// paths of the pictures. Nodes that are equal and outputs that are no numbers have none.
pub(super) fn draw(checked: &[Checked], folder: &Path) -> Result<Vec<PathBuf>, DivergenceError> {
    let write = |path: &Path, error| DivergenceError::Write { path: path.to_owned(), error };
    std::fs::create_dir_all(folder).map_err(|error| write(folder, error))?;
    let mut pictures = Vec::new();
    for (checked, report) in checked.iter().filter_map(|checked| Some((checked, checked.result.as_ref().ok()?))) {
        for (subject, change) in &report.changes.subjects {
            let Some((field, _)) = &change.largest else { continue };
            let journal = JournalReader::open(&checked.path)?;
            let name = format!("{}-{subject}-{field}", report.node);
            let path = folder.join(file_name(&name)).with_added_extension("svg");
            let picture = picture(subject, field, &trace(&journal, subject, field)?);
            let svg = picture.map_err(|problem| DivergenceError::Drawing { path: path.clone(), problem })?;
            std::fs::write(&path, svg).map_err(|error| write(&path, error))?;
            pictures.push(path);
        }
    }
    Ok(pictures)
}

fn picture(subject: &str, field: &str, trace: &Trace) -> Result<String, String> {
    let curve = |value: fn(&trench_harness::replay::Sample) -> Option<f64>| {
        let points = trace.samples.iter().filter_map(|sample| Some((sample.seconds, value(sample)?)));
        points.filter(|(_, value)| value.is_finite()).collect::<Vec<_>>()
    };
    let values = vec![curve(|sample| sample.recorded), curve(|sample| sample.now)];
    let difference = curve(|sample| Some(sample.now? - sample.recorded?));
    let names = ["recorded".to_owned(), "now".to_owned()];
    let notes = format!("{subject}: {field}, below: now less recorded");
    diagrams(
        &names,
        &notes,
        "since the first event (s)",
        &[(field.to_owned(), values), ("difference".to_owned(), vec![difference])],
    )
}

/// A name without the characters that paths and shells give a meaning.
fn file_name(name: &str) -> String {
    let plain = name.trim_start_matches('/').chars();
    plain.map(|letter| if letter.is_ascii_alphanumeric() || "._-".contains(letter) { letter } else { '.' }).collect()
}
