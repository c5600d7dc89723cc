//! Which topic a channel is, and how many messages it has.

use crate::reader::Topic;
use crate::reader::summary_section::SummarySection;
use mcap::records::Channel;
use std::collections::BTreeMap;

/// The channels of one file, growing while it is scanned.
pub(super) struct Channels<'a> {
    topics: &'a mut Vec<Topic>,
    schemas: BTreeMap<u16, (String, String)>,
    channels: BTreeMap<u16, usize>,
    counted: u64,
    unknown: u64,
}

impl<'a> Channels<'a> {
    pub(super) fn new(topics: &'a mut Vec<Topic>) -> Self {
        Self { topics, schemas: BTreeMap::new(), channels: BTreeMap::new(), counted: 0, unknown: 0 }
    }

    /// Learns all channels from the summary, in case that the chunk that defines them is lost.
    pub(super) fn seed(&mut self, summary: SummarySection) {
        self.schemas = summary.schemas;
        for channel in summary.channels {
            self.add_channel(channel);
        }
    }

    pub(super) fn add_schema(&mut self, id: u16, name: String, definition: &[u8]) {
        self.schemas.entry(id).or_insert_with(|| (name, String::from_utf8_lossy(definition).into_owned()));
    }

    /// Adds a channel. The first definition of an id holds.
    pub(super) fn add_channel(&mut self, mut channel: Channel) {
        if self.channels.contains_key(&channel.id) {
            return;
        }
        let (type_name, definition) = self.schemas.get(&channel.schema_id).cloned().unwrap_or_default();
        let known = self.topics.iter().position(|topic| topic.name == channel.topic && topic.type_name == type_name);
        let index = known.unwrap_or_else(|| {
            self.topics.push(Topic {
                name: channel.topic,
                type_name,
                type_hash: channel.metadata.remove("topic_type_hash").unwrap_or_default(),
                definition,
                offered_qos: channel.metadata.remove("offered_qos_profiles").unwrap_or_default(),
                message_count: 0,
                largest: 0,
            });
            self.topics.len() - 1
        });
        self.channels.insert(channel.id, index);
    }

    /// Counts a message of `length` bytes. Whether its channel is known.
    pub(super) fn count(&mut self, channel: u16, length: usize) -> bool {
        match self.channels.get(&channel).and_then(|&index| self.topics.get_mut(index)) {
            Some(topic) => {
                topic.message_count += 1;
                topic.largest = topic.largest.max(length);
                self.counted += 1;
                true
            }
            None => {
                self.unknown += 1;
                false
            }
        }
    }

    /// Messages of known and of unknown channels.
    pub(super) fn totals(&self) -> (u64, u64) {
        (self.counted, self.unknown)
    }

    pub(super) fn finish(self) -> BTreeMap<u16, usize> {
        self.channels
    }
}
