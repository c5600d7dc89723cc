//! A journal being written.

use crate::JournalError;
use crate::file::JournalFile;
use crate::make::Pace;
use crate::queue::{LIMIT, Queue};
use crate::record::End;
use crate::start::Start;
use std::path::Path;
use trench_core::Times;

/// Takes steps. It ends, marked as clean, when it is dropped.
pub struct Journal {
    target: Target,
    keeps_large: bool,
}

enum Target {
    Thread(Queue),
    Direct(Box<JournalFile>),
    /// Nothing more is written.
    Ended,
}

impl Journal {
    /// Makes the file of the node that `start` describes, in `folder`.
    ///
    /// # Errors
    /// When the file or its thread cannot be made.
    pub fn create(folder: &Path, start: &Start, pace: Pace) -> Result<Self, JournalError> {
        let name = start.full_name().trim_start_matches('/').replace('/', ".");
        let file = JournalFile::create(folder, &name, start, pace)?;
        let target = match pace {
            Pace::RealTime => Target::Thread(Queue::start(file, LIMIT).map_err(JournalError::io(folder))?),
            Pace::LockStep => Target::Direct(Box::new(file)),
        };
        Ok(Self { target, keeps_large: start.keeps_large })
    }

    /// Writes over the file at `path`, as fast as the disk goes.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn replace(path: &Path, start: &Start) -> Result<Self, JournalError> {
        let file = JournalFile::replace(path, start)?;
        Ok(Self { target: Target::Direct(Box::new(file)), keeps_large: start.keeps_large })
    }

    /// Whether large inputs are kept by value.
    #[must_use]
    pub fn keeps_large(&self) -> bool {
        self.keeps_large
    }

    /// Adds a step: the records of one event. Where that is not possible the journal ends, and the reason comes back,
    /// once.
    ///
    /// # Errors
    /// When the journal ends here.
    pub fn append(&mut self, at: Times, step: Vec<u8>) -> Result<(), String> {
        let done = match &mut self.target {
            Target::Thread(queue) => queue.push((at, step)),
            Target::Direct(file) => file.append(at, &step).map_err(|error| error.to_string()),
            Target::Ended => return Ok(()),
        };
        if done.is_err() {
            self.target = Target::Ended;
        }
        done
    }

    /// Writes what is left. A journal that is only dropped does the same and keeps silent about what goes wrong.
    ///
    /// # Errors
    /// When the disk cannot take it. In real time the thread writes it, and nobody waits for its verdict.
    pub fn finish(mut self) -> Result<(), JournalError> {
        self.end()
    }

    fn end(&mut self) -> Result<(), JournalError> {
        match std::mem::replace(&mut self.target, Target::Ended) {
            Target::Direct(file) => file.finish(End::Clean),
            Target::Thread(_) | Target::Ended => Ok(()),
        }
    }
}

impl Drop for Journal {
    fn drop(&mut self) {
        // A reader sees the missing end.
        let _incomplete = self.end();
    }
}
