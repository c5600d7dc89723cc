//! A bag in memory: those of its messages that make a picture.

use crate::Role;
use std::collections::BTreeMap;
use trench_bag::{BagError, BagReader};
use trench_core::RosTime;

/// What is held in memory at most, bytes: hours of twenty robots.
const MOST: usize = 1 << 30;

/// Why there is nothing to show.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The bag cannot be read.
    #[error(transparent)]
    Bag(#[from] BagError),
    /// None of its topics makes a picture.
    #[error("the bag has no /team_state and no other topic that can be shown; record with trench bag record")]
    Nothing,
    /// It is too long.
    #[error("the bag holds more than {} MiB of messages to show; cut a shorter one out of it", MOST >> 20)]
    TooLarge,
}

/// The messages of a bag in the order of their log times.
#[derive(Debug, Default)]
pub struct Recording {
    roles: Vec<Role>,
    messages: Vec<Entry>,
    bytes: Vec<u8>,
    /// Indices of the messages of lasting topics.
    lasting: Vec<usize>,
}

#[derive(Debug, Clone, Copy)]
struct Entry {
    time: RosTime,
    role: usize,
    start: usize,
    end: usize,
}

/// One of them.
pub(crate) struct Recorded<'a> {
    pub(crate) time: RosTime,
    pub(crate) role: &'a Role,
    pub(crate) cdr: &'a [u8],
}

impl Recording {
    /// Reads a bag.
    ///
    /// # Errors
    /// When it cannot be read, or there is nothing in it to show.
    pub fn load(bag: &BagReader) -> Result<Self, LoadError> {
        let mut recording = Self::default();
        let mut channels = BTreeMap::new();
        for (index, topic) in bag.topics().iter().enumerate() {
            if let Some(role) = Role::of(&topic.name, &topic.type_name) {
                channels.insert(index, recording.roles.len());
                recording.roles.push(role);
            }
        }
        for message in bag.messages() {
            let message = message?;
            let Some(&role) = channels.get(&message.topic) else { continue };
            let time = RosTime(i64::try_from(message.log_time).unwrap_or(i64::MAX));
            recording.push(time, role, &message)?;
        }
        if recording.messages.is_empty() { Err(LoadError::Nothing) } else { Ok(recording) }
    }

    fn push(&mut self, time: RosTime, role: usize, cdr: &[u8]) -> Result<(), LoadError> {
        let start = self.bytes.len();
        if start + cdr.len() > MOST {
            return Err(LoadError::TooLarge);
        }
        self.bytes.extend_from_slice(cdr);
        if self.roles.get(role).is_some_and(Role::is_lasting) {
            self.lasting.push(self.messages.len());
        }
        self.messages.push(Entry { time, role, start, end: self.bytes.len() });
        Ok(())
    }

    /// How long it is, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.messages.last().map_or(0.0, |last| last.time.seconds_since(self.start()))
    }

    /// When it begins.
    pub(crate) fn start(&self) -> RosTime {
        self.messages.first().map_or(RosTime(0), |first| first.time)
    }

    pub(crate) fn get(&self, index: usize) -> Option<Recorded<'_>> {
        let entry = self.messages.get(index)?;
        let cdr = self.bytes.get(entry.start..entry.end)?;
        Some(Recorded { time: entry.time, role: self.roles.get(entry.role)?, cdr })
    }

    /// How many messages there are up to and at `time`.
    pub(crate) fn until(&self, time: RosTime) -> usize {
        self.messages.partition_point(|entry| entry.time <= time)
    }

    /// The messages of lasting topics before message `end`.
    pub(crate) fn lasting(&self, end: usize) -> impl Iterator<Item = usize> {
        self.lasting.iter().copied().take_while(move |index| *index < end)
    }
}
