//! Which topic a channel is, and how many messages it has.

use crate::reader::Topic;
use mcap::records::{Channel, Statistics};
use std::collections::BTreeMap;

/// The most that all definitions of a file may take in memory, bytes: a few compressed bytes can claim thousands of
/// topics with a large type each.
const MOST: usize = 16 << 20;
/// What a topic takes besides its texts, bytes.
const OVERHEAD: usize = 256;

/// The channels of one file, growing while it is scanned.
pub(in crate::reader) struct Channels<'a> {
    topics: &'a mut Vec<Topic>,
    schemas: BTreeMap<u16, (String, String)>,
    channels: BTreeMap<u16, usize>,
    /// What the definitions take so far, bytes.
    kept: usize,
    totals: Totals,
}

/// What was counted in one file.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::reader) struct Totals {
    /// Messages of known channels.
    pub(in crate::reader) counted: u64,
    /// Messages of unknown ones.
    pub(in crate::reader) unknown: u64,
    /// Definitions that are too large.
    pub(in crate::reader) refused: u64,
}

impl<'a> Channels<'a> {
    pub(super) fn new(topics: &'a mut Vec<Topic>) -> Self {
        Self { topics, schemas: BTreeMap::new(), channels: BTreeMap::new(), kept: 0, totals: Totals::default() }
    }

    /// Counts a definition that is too large.
    pub(super) fn refuse(&mut self) {
        self.totals.refused += 1;
    }

    /// Whether there is room for a definition of so many bytes.
    fn make_room(&mut self, bytes: usize) -> bool {
        let kept = self.kept.saturating_add(bytes + OVERHEAD);
        let is_room = kept <= MOST;
        if is_room {
            self.kept = kept;
        } else {
            self.refuse();
        }
        is_room
    }

    /// Adds a type. The first definition of an id holds.
    pub(in crate::reader) fn add_schema(&mut self, id: u16, name: String, definition: &[u8]) {
        if self.schemas.contains_key(&id) {
            return;
        }
        // Bytes that are no text take three times as many as text.
        let definition = String::from_utf8_lossy(definition).into_owned();
        if self.make_room(name.len() + definition.len()) {
            self.schemas.insert(id, (name, definition));
        }
    }

    /// Adds a channel. The first definition of an id holds.
    pub(in crate::reader) fn add_channel(&mut self, mut channel: Channel) {
        if self.channels.contains_key(&channel.id) {
            return;
        }
        let nothing = (String::new(), String::new());
        let (type_name, definition) = self.schemas.get(&channel.schema_id).unwrap_or(&nothing);
        let known = self.topics.iter().position(|topic| topic.name == channel.topic && topic.type_name == *type_name);
        if let Some(index) = known {
            self.channels.insert(channel.id, index);
            return;
        }
        let (type_name, definition) = (type_name.clone(), definition.clone());
        let type_hash = channel.metadata.remove("topic_type_hash").unwrap_or_default();
        let offered_qos = channel.metadata.remove("offered_qos_profiles").unwrap_or_default();
        let name = channel.topic;
        if !self
            .make_room([&name, &type_name, &definition, &type_hash, &offered_qos].map(|text| text.len()).iter().sum())
        {
            return;
        }
        self.topics.push(Topic { name, type_name, type_hash, definition, offered_qos, message_count: 0 });
        self.channels.insert(channel.id, self.topics.len() - 1);
    }

    /// Counts a message. Whether its channel is known.
    pub(super) fn count(&mut self, channel: u16) -> bool {
        let is_known = self.add(channel, 1);
        self.totals.unknown += u64::from(!is_known);
        is_known
    }

    /// Counts all messages of a file as its statistics do; nothing where these are not of the channels known here.
    pub(super) fn believe(&mut self, statistics: &Statistics) -> bool {
        let counts = &statistics.channel_message_counts;
        let sum = counts.values().try_fold(0_u64, |sum, &count| sum.checked_add(count));
        let is_believed = sum == Some(statistics.message_count) && counts.keys().all(|&id| self.is_known(id));
        is_believed && counts.iter().all(|(&channel, &count)| self.add(channel, count))
    }

    pub(super) fn is_known(&self, channel: u16) -> bool {
        self.channels.contains_key(&channel)
    }

    fn add(&mut self, channel: u16, count: u64) -> bool {
        let topic = self.channels.get(&channel).and_then(|&index| self.topics.get_mut(index));
        let Some(topic) = topic else { return false };
        topic.message_count = topic.message_count.saturating_add(count);
        self.totals.counted = self.totals.counted.saturating_add(count);
        true
    }

    pub(super) fn totals(&self) -> Totals {
        self.totals
    }

    pub(super) fn finish(self) -> BTreeMap<u16, usize> {
        self.channels
    }
}
