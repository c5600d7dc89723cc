//! The network end of a publication.

use super::Images;
use super::longest::longest_annotated;
use super::raw::{RawAdapter, RawMessage};
use crate::transport::network::{Congested, Gid, NetworkWriter};
use rustdds::bytes::Bytes;
use rustdds::no_key::DataWriter;
use rustdds::{GUID, RTPSEntity, SampleIdentity, SequenceNumber, Timestamp, WriteOptions, WriteOptionsBuilder};
use std::collections::{BTreeSet, VecDeque};
use std::time::Duration;

/// Messages that may wait for room in the send window, which itself holds 8192 unacknowledged samples. Whoever is this
/// far behind is not coming back; memory ends somewhere.
const WAITING: usize = 8192;

/// Writes messages in order and never blocks: what the send window does not take waits here.
pub(crate) struct DdsWriter {
    writer: DataWriter<RawMessage, RawAdapter>,
    waiting: VecDeque<(RawMessage, WriteOptions)>,
    accepted: u64,
    /// The way of images, on topics that may have some.
    images: Option<Images>,
    /// Whether messages are encrypted.
    is_secured: bool,
}

impl DdsWriter {
    pub(super) fn new(writer: DataWriter<RawMessage, RawAdapter>, is_secured: bool) -> Self {
        Self { writer, waiting: VecDeque::new(), accepted: 0, images: None, is_secured }
    }

    /// Images will take a way of their own.
    pub(super) fn with_images(mut self, images: Images) -> Self {
        self.images = Some(images);
        self
    }

    /// Like [`NetworkWriter::write`], saying which request a response answers.
    pub(super) fn write_related(&mut self, message: Bytes, related: SampleIdentity) -> Result<u64, Congested> {
        self.write_with(message, WriteOptionsBuilder::new().related_sample_identity(related))
    }

    fn write_with(&mut self, message: Bytes, options: WriteOptionsBuilder) -> Result<u64, Congested> {
        if !self.has_room() {
            return Err(Congested);
        }
        let message = RawMessage(message);
        let message = if self.is_secured { message.in_whole_words() } else { message };
        self.waiting.push_back((message, options.source_timestamp(Timestamp::now()).build()));
        self.accepted += 1;
        self.flush();
        Ok(self.accepted)
    }

    /// The count of the message that is written next; none while others wait before it.
    pub(super) fn next_number(&self) -> Option<u64> {
        self.waiting.is_empty().then_some(self.accepted + 1)
    }

    pub(crate) fn guid(&self) -> GUID {
        self.writer.guid()
    }
}

impl NetworkWriter for DdsWriter {
    fn gid(&self) -> Gid {
        gid(self.writer.guid())
    }

    fn has_room(&self) -> bool {
        self.waiting.len() < WAITING
    }

    fn write(&mut self, message: Bytes) -> Result<u64, Congested> {
        self.write_with(message, WriteOptionsBuilder::new())
    }

    /// Readers of ours are told the writer's own count where the network's differs.
    fn write_counted(&mut self, message: Bytes, count: u64) -> Result<(), Congested> {
        if self.images.as_mut().is_some_and(|images| images.take(count, &message)) {
            self.accepted = count;
            return Ok(());
        }
        let mut options = WriteOptionsBuilder::new();
        if count != self.accepted + 1 && message.len() <= longest_annotated() {
            let sequence_number = SequenceNumber::from(i64::try_from(count).unwrap_or(i64::MAX));
            options = options.related_sample_identity(SampleIdentity { writer_guid: self.guid(), sequence_number });
        }
        self.write_with(message, options).map(|_accepted| ())
    }

    fn longest_counted(&self) -> usize {
        longest_annotated()
    }

    fn flush(&mut self) -> bool {
        while let Some((message, options)) = self.waiting.pop_front() {
            // A message is a counted reference to bytes: this clone copies none of them.
            if self.writer.write_with_options(message.clone(), options.clone()).is_err() {
                self.waiting.push_front((message, options));
                return false;
            }
        }
        true
    }

    fn settle(&mut self, max_wait: Duration) {
        self.flush();
        let _given_up = self.writer.wait_for_acknowledgments(max_wait);
    }

    fn limit(&mut self, rate: f64) {
        if let Some(images) = &mut self.images {
            images.limit(rate);
        }
    }

    fn readers_changed(&mut self, readers: &BTreeSet<Gid>) {
        if let Some(images) = &mut self.images {
            images.readers_changed(readers);
        }
    }
}

/// A DDS identity as ROS 2 shows it.
pub(super) fn gid(guid: GUID) -> Gid {
    guid.to_bytes()
}
