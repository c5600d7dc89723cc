//! The network end of a subscription.

use super::raw::{RawAdapter, RawMessage};
use super::writer::gid;
use rustdds::bytes::Bytes;
use rustdds::mio1::{Interest, Registry, Token, event};
use rustdds::no_key::{DeserializedCacheChange, SimpleDataReader};
use rustdds::{GUID, SampleIdentity};
use std::io;
use trench_core::Source;

/// A message from the network.
#[derive(Debug)]
pub(crate) struct NetworkSample {
    /// Writer and count.
    pub(crate) source: Source,
    /// CDR with its header.
    pub(crate) cdr: Bytes,
    pub(super) identity: SampleIdentity,
    pub(super) related: Option<SampleIdentity>,
}

/// Takes messages in the order of each writer.
pub(crate) struct NetworkReader {
    reader: SimpleDataReader<RawMessage, RawAdapter>,
}

impl NetworkReader {
    pub(super) fn new(reader: SimpleDataReader<RawMessage, RawAdapter>) -> Self {
        Self { reader }
    }

    /// Acknowledges the wake-up; to be called before taking, or a later arrival may go unnoticed.
    pub(crate) fn clear_wakeup(&self) {
        self.reader.drain_read_notifications();
    }

    /// The next message, or what is wrong with it; `None` when all are taken.
    pub(crate) fn take(&self) -> Option<Result<NetworkSample, String>> {
        match self.reader.try_take_one() {
            Ok(None) => None,
            Ok(Some(change)) => Some(Ok(sample(change))),
            Err(error) => Some(Err(error.to_string())),
        }
    }

    pub(crate) fn guid(&self) -> GUID {
        self.reader.guid()
    }
}

fn sample(change: DeserializedCacheChange<RawMessage>) -> NetworkSample {
    let identity = SampleIdentity { writer_guid: change.writer_guid, sequence_number: change.sequence_number };
    // RTPS counts from 1 and never below.
    let sequence = u64::try_from(i64::from(change.sequence_number)).unwrap_or(0);
    let source = Source { gid: gid(change.writer_guid), sequence };
    let related = change.related_sample_identity();
    NetworkSample { source, identity, related, cdr: change.into_value().0 }
}

impl event::Source for NetworkReader {
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
