//! Making cores, with a journal where one is asked for.

use crate::JournalError;
use crate::journal::Journal;
use crate::journalled::Journalled;
use crate::kept_files::KeptFiles;
use crate::start::{Ports, Start, kept};
use std::path::PathBuf;
use trench_config::Parameters;
use trench_core::arguments::Names;
use trench_core::{Files, NodeContext, NodeCore, NodeDescription, StartError};

/// Where journals go and what they hold.
#[derive(Debug, Clone)]
pub struct Journals {
    /// One file a node.
    pub folder: PathBuf,
    /// Whether images that nodes read are kept by value (some 40 MB/s), so that their readers can be checked.
    pub images: bool,
    /// Whether robots wait.
    pub pace: Pace,
}

/// How fast steps come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pace {
    /// A thread writes; the journal ends rather than that anybody waits for the disk.
    RealTime,
    /// The simulation waits. The same run gives the same file.
    LockStep,
}

impl Pace {
    /// Of zstd; nothing where it would cost too much. Robots' controllers need the processor, simulations leave files
    /// that stay.
    pub(crate) fn compression_level(self, keeps_large: bool) -> Option<u32> {
        match (self, keeps_large) {
            (Self::RealTime, false) => Some(1),
            // Images of a noisy camera hardly shrink, and compressing them would cost a processor.
            (Self::RealTime, true) => None,
            (Self::LockStep, false) => Some(19),
            (Self::LockStep, true) => Some(9),
        }
    }
}

/// Why a core was not made.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// It refuses.
    #[error(transparent)]
    Start(#[from] StartError),
    /// Its journal cannot be written.
    #[error("journal: {0}")]
    Journal(#[from] JournalError),
}

/// Makes a core as `description` does; with `journals`, one that keeps a journal.
///
/// # Errors
/// When the core refuses to start, or its journal cannot be made.
pub fn build(
    description: &NodeDescription,
    context: &NodeContext,
    parameters: &Parameters,
    files: &dyn Files,
    names: &Names<'_>,
    journals: Option<&Journals>,
) -> Result<Box<dyn NodeCore>, BuildError> {
    let Some(journals) = journals else { return Ok((description.build)(context, parameters, files)?) };
    let files = KeptFiles::new(files);
    let core = (description.build)(context, parameters, &files)?;
    let start = Start {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        description: description.name.to_owned(),
        namespace: context.namespace.clone(),
        name: context.name.clone(),
        checkpoint: context.checkpoint.clone(),
        seed: context.seed,
        wall: context.wall.0,
        parameters: kept(parameters),
        files: files.into_texts(),
        ports: Ports::of(core.interface(), names),
        keeps_large: journals.images,
    };
    let journal = Journal::create(&journals.folder, &start, journals.pace)?;
    Ok(Box::new(Journalled::new(core, journal)))
}
