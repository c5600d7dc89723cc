//! Telling the processes of a launch to keep journals.

use super::LaunchError;
use clap::ValueEnum;
use std::path::{Path, PathBuf};
use trench_bag::recorder;
use trench_journal::Disk;
use trench_launch::{Plan, Process};

/// What journals keep by value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Kept {
    /// All inputs but images.
    Messages,
    /// All inputs.
    Images,
}

/// Sets the variables of all processes. What the launch file sets itself stays.
pub(super) fn keep(plan: &mut Plan, kept: Kept, run_folder: &Path) -> Result<(), LaunchError> {
    let folder = match bag(plan) {
        Some(bag) => std::path::absolute(bag)?.with_file_name("journals"),
        None => run_folder.join("journals"),
    };
    // Journals of two runs in one folder would be taken for one.
    if folder.exists() {
        return Err(LaunchError::JournalsExist(folder));
    }
    let images = if kept == Kept::Images { "1" } else { "0" };
    let variables =
        [("TRENCH_JOURNAL_DIR", folder.display().to_string()), ("TRENCH_JOURNAL_IMAGES", images.to_owned())];
    for process in &mut plan.processes {
        for (name, value) in &variables {
            process.environment.entry((*name).to_owned()).or_insert_with(|| Some(value.clone()));
        }
    }
    Ok(())
}

/// The bag that the launch records.
fn bag(plan: &Plan) -> Option<PathBuf> {
    let recorder = recorder::description();
    let records = |process: &&Process| {
        let program = process.argv.first().map(Path::new).and_then(Path::file_name);
        program.is_some_and(|name| name == recorder.name)
    };
    let process = plan.processes.iter().find(records)?;
    // A recorder with wrong parameters says so itself.
    let (_, parameters) = trench_harness::parameters(&recorder, process, &Disk).ok()?.pop()?;
    parameters.str("output").ok().filter(|output| !output.is_empty()).map(PathBuf::from)
}
