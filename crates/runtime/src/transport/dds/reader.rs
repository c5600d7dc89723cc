//! The network end of a subscription.

use super::raw::{RawAdapter, RawMessage};
use super::writer::gid;
use crate::clock::steady_now;
use crate::transport::network::{Gid, NetworkReader, NetworkSample};
use rustdds::bytes::Bytes;
use rustdds::mio1::{Interest, Registry, Token, event};
use rustdds::no_key::{DeserializedCacheChange, SimpleDataReader};
use rustdds::{GUID, SampleIdentity, Timestamp};
use std::io;
use trench_core::{Source, Steady};

/// A message with what services need to know of it.
#[derive(Debug)]
pub(super) struct DdsSample {
    /// Writer and count.
    source: Source,
    /// CDR with its header.
    pub(super) cdr: Bytes,
    pub(super) identity: SampleIdentity,
    pub(super) related: Option<SampleIdentity>,
    /// When it came, by the wall clock.
    received: Timestamp,
}

/// Takes messages in the order of each writer.
pub(crate) struct DdsReader {
    reader: SimpleDataReader<RawMessage, RawAdapter>,
}

impl DdsReader {
    pub(super) fn new(reader: SimpleDataReader<RawMessage, RawAdapter>) -> Self {
        Self { reader }
    }

    /// The next message, or what is wrong with it; `None` when all are taken.
    pub(super) fn take_identified(&self) -> Option<Result<DdsSample, String>> {
        match self.reader.try_take_one() {
            Ok(None) => None,
            Ok(Some(change)) => Some(Ok(sample(change))),
            Err(error) => Some(Err(error.to_string())),
        }
    }

    pub(super) fn guid(&self) -> GUID {
        self.reader.guid()
    }
}

impl NetworkReader for DdsReader {
    fn gid(&self) -> Gid {
        gid(self.guid())
    }

    fn clear_wakeup(&self) {
        self.reader.drain_read_notifications();
    }

    fn take(&self) -> Option<Result<NetworkSample, String>> {
        let taken = self.take_identified()?;
        Some(taken.map(|sample| NetworkSample {
            source: sample.source,
            cdr: sample.cdr,
            arrived: steady(sample.received),
        }))
    }
}

/// The monotonic time of a moment of the wall clock that has just been.
fn steady(wall: Timestamp) -> Steady {
    // Ticks are 2^-32 s. A clock that was set back meanwhile makes it now.
    let ticks = Timestamp::now().to_ticks().saturating_sub(wall.to_ticks());
    let age = (u128::from(ticks) * 1_000_000_000) >> 32;
    Steady(steady_now().0.saturating_sub(u64::try_from(age).unwrap_or(0)))
}

fn sample(change: DeserializedCacheChange<RawMessage>) -> DdsSample {
    let identity = SampleIdentity { writer_guid: change.writer_guid, sequence_number: change.sequence_number };
    let related = change.related_sample_identity();
    // A writer of ours whose network has rested says its own count.
    let own = related.filter(|related| related.writer_guid == change.writer_guid);
    // RTPS counts from 1 and never below.
    let sequence = i64::from(own.map_or(change.sequence_number, |own| own.sequence_number));
    let source = Source { gid: gid(change.writer_guid), sequence: u64::try_from(sequence).unwrap_or(0) };
    let received = change.receive_instant;
    DdsSample { source, identity, related, received, cdr: change.into_value().0 }
}

impl event::Source for DdsReader {
    fn register(&mut self, registry: &Registry, token: Token, interests: Interest) -> io::Result<()> {
        self.reader.register(registry, token, interests)
    }

    fn reregister(&mut self, registry: &Registry, token: Token, interests: Interest) -> io::Result<()> {
        self.reader.reregister(registry, token, interests)
    }

    fn deregister(&mut self, registry: &Registry) -> io::Result<()> {
        self.reader.deregister(registry)
    }
}
