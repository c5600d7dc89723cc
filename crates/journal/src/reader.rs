//! Reading a journal.

use crate::JournalError;
use crate::file::{CHANNEL, FORMAT};
use crate::record::{End, Record, Records};
use crate::start::Start;
use std::path::{Path, PathBuf};
use trench_bag::{BagMessage, BagReader, Messages};
use trench_core::{RosTime, Steady, Times};

/// A journal, opened and checked.
pub struct JournalReader {
    path: PathBuf,
    bag: BagReader,
    start: Start,
}

/// One event with what came of it.
#[derive(Clone)]
pub struct Step {
    /// Both times of the event.
    pub at: Times,
    message: BagMessage,
}

/// Where and why a journal cannot be followed any further.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{reason}")]
pub struct Break {
    /// What is missing.
    pub reason: String,
}

impl JournalReader {
    /// Opens the journal at `path`.
    ///
    /// # Errors
    /// When the file is no journal, is of another format, or has lost its beginning.
    pub fn open(path: &Path) -> Result<Self, JournalError> {
        let bag = BagReader::open(path)?;
        let no_start = |problem: &str| {
            let damage: String = bag.damage().iter().map(|damage| format!("; {damage}")).collect();
            JournalError::NoStart { path: path.to_owned(), problem: format!("{problem}{damage}") }
        };
        if bag.topic(CHANNEL).is_none() {
            return Err(no_start("it has no steps"));
        }
        let first = bag.messages().next().ok_or_else(|| no_start("it is empty"))??;
        if first.sequence != 0 {
            return Err(no_start("its first record is lost"));
        }
        let (found, rest) = postcard::take_from_bytes(&first).map_err(|_| no_start("it names no format"))?;
        if found != FORMAT {
            return Err(JournalError::Format { path: path.to_owned(), found, known: FORMAT });
        }
        let start = postcard::from_bytes(rest).map_err(|_| no_start("its first record is not understood"))?;
        Ok(Self { path: path.to_owned(), bag, start })
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// How many steps it has; its start and its end count too.
    #[must_use]
    pub fn step_count(&self) -> u64 {
        self.bag.message_count()
    }

    /// The length of the file, bytes.
    #[must_use]
    pub fn length(&self) -> u64 {
        self.bag.files().map(|(_, length)| length).sum()
    }

    /// What the core was made from.
    #[must_use]
    pub fn start(&self) -> &Start {
        &self.start
    }

    /// All steps in order. Ends behind a clean end; anything else gives a [`Break`] first.
    #[must_use]
    pub fn steps(&self) -> Steps<'_> {
        Steps { messages: self.bag.messages(), damage: self.damage(), next: 0, is_over: false }
    }

    fn damage(&self) -> String {
        self.bag.damage().iter().map(|damage| format!("; {}", damage.what)).collect()
    }
}

impl Step {
    /// The input and its outputs.
    #[must_use]
    pub fn records(&self) -> Records<'_> {
        Records::new(&self.message)
    }

    /// The step with other outputs; `behind_input` are its records behind the first.
    #[must_use]
    pub fn with_outputs(&self, behind_input: &Records<'_>, outputs: &[u8]) -> Vec<u8> {
        let input = self.message.len().saturating_sub(behind_input.rest().len());
        [self.message.get(..input).unwrap_or_default(), outputs].concat()
    }
}

/// An iterator over the steps of a journal.
pub struct Steps<'a> {
    messages: Messages<&'a BagReader>,
    damage: String,
    /// The number that the next message must have.
    next: u32,
    is_over: bool,
}

impl Steps<'_> {
    fn stop(&mut self, reason: &str) -> Option<Result<Step, Break>> {
        self.is_over = true;
        Some(Err(Break { reason: format!("{reason}{}", self.damage) }))
    }
}

impl Iterator for Steps<'_> {
    type Item = Result<Step, Break>;

    fn next(&mut self) -> Option<Self::Item> {
        while !self.is_over {
            let message = match self.messages.next() {
                None => return self.stop("the journal has no end: its process was killed, or its end is lost"),
                Some(Err(error)) => return self.stop(&error.to_string()),
                Some(Ok(message)) => message,
            };
            if message.sequence != self.next {
                let (lost, from) = (message.sequence.wrapping_sub(self.next), self.next);
                return self.stop(&format!("{lost} steps from number {from} on are lost"));
            }
            self.next = self.next.wrapping_add(1);
            if self.next == 1 {
                continue; // The start.
            }
            let at = Times { ros: RosTime(message.publish_time.cast_signed()), steady: Steady(message.log_time) };
            match Records::new(&message).next() {
                Some(Record::Input(_)) => return Some(Ok(Step { at, message })),
                Some(Record::End(End::Clean)) => self.is_over = true,
                Some(Record::End(End::Overflow)) => return self.stop("the disk was too slow for the journal"),
                Some(Record::Output(_)) | None => return self.stop("a step is not understood"),
            }
        }
        None
    }
}
