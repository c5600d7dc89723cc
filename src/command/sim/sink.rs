//! Where messages of a simulation go: into the run that is judged, and into a bag.

use std::collections::BTreeMap;
use std::path::Path;
use trench_bag::run::{Run, RunBuilder};
use trench_bag::{BagError, BagWriter, Stamp, TopicId, TopicType, WriteOptions};
use trench_core::Qos;
use trench_msgs::{Encode, Message, TypeInfo};

/// Takes messages in order of time.
pub(crate) struct Sink {
    builder: RunBuilder,
    bag: Option<BagWriter>,
    topics: BTreeMap<String, TopicId>,
    /// The first that went wrong; after it the bag gets nothing more.
    error: Option<BagError>,
}

impl Sink {
    /// With a bag in a folder that does not exist yet, or without.
    pub(crate) fn new(folder: Option<&Path>) -> Result<Self, BagError> {
        let bag = folder.map(|folder| BagWriter::create(folder, WriteOptions::reproducible())).transpose()?;
        Ok(Self { builder: RunBuilder::default(), bag, topics: BTreeMap::new(), error: None })
    }

    /// Takes an encoded message; the time is in ns.
    pub(crate) fn take(
        &mut self,
        time: i64,
        topic: &str,
        (kind, qos): (&'static TypeInfo, Qos),
        sequence: u32,
        cdr: &[u8],
    ) {
        self.builder.take(topic, kind.name, cdr);
        if self.error.is_none() {
            self.error = self.record(time, topic, (kind, qos), sequence, cdr).err();
        }
    }

    /// Takes a message.
    pub(crate) fn publish<M: Message + Encode>(&mut self, time: i64, topic: &str, qos: Qos, message: &M) {
        self.take(time, topic, (M::TYPE, qos), 0, &message.to_cdr());
    }

    fn record(
        &mut self,
        time: i64,
        topic: &str,
        (kind, qos): (&'static TypeInfo, Qos),
        sequence: u32,
        cdr: &[u8],
    ) -> Result<(), BagError> {
        let Some(bag) = &mut self.bag else { return Ok(()) };
        let id = match self.topics.get(topic) {
            Some(&id) => id,
            None => {
                let id = bag.add_topic(topic, TopicType::from(kind), qos)?;
                self.topics.insert(topic.to_owned(), id);
                id
            }
        };
        let nanoseconds = u64::try_from(time).unwrap_or(0);
        bag.write(id, Stamp { log_time: nanoseconds, publish_time: nanoseconds, sequence }, cdr)
    }

    /// Finishes the bag.
    pub(crate) fn finish(self) -> Result<Run, BagError> {
        match (self.error, self.bag) {
            (Some(error), _) => return Err(error),
            (None, Some(bag)) => bag.finish()?,
            (None, None) => {}
        }
        Ok(self.builder.finish())
    }
}
