//! What changes in the ROS graph around this process.

use super::name::{ros_topic, ros_type};
use super::writer::gid;
use crate::transport::network::{GraphChange, GraphWatch};
use rustdds::mio1::{Interest, Registry, Token, event};
use rustdds::{DomainParticipantStatusEvent as Status, DomainParticipantStatusListener, GUID, StatusEvented};
use std::collections::{BTreeMap, BTreeSet};
use std::io;

/// Follows the matches of all readers and writers of this process.
pub(crate) struct StatusReader {
    listener: DomainParticipantStatusListener,
    writers_of: BTreeMap<GUID, BTreeSet<GUID>>,
    readers_of: BTreeMap<GUID, BTreeSet<GUID>>,
}

impl StatusReader {
    pub(super) fn new(listener: DomainParticipantStatusListener) -> Self {
        Self { listener, writers_of: BTreeMap::new(), readers_of: BTreeMap::new() }
    }

    fn follow(&mut self, status: Status, changes: &mut Vec<GraphChange>) {
        match status {
            Status::RemoteWriterMatched { local_reader, remote_writer } => {
                let writers = self.writers_of.entry(local_reader).or_default();
                if writers.insert(remote_writer) {
                    changes.push(presence(local_reader, remote_writer, true));
                    changes.push(GraphChange::Matched { reader: gid(local_reader), writers: writers.len() });
                }
            }
            Status::RemoteReaderMatched { local_writer, remote_reader } => {
                let readers = self.readers_of.entry(local_writer).or_default();
                if readers.insert(remote_reader) {
                    changes.push(matched_readers(local_writer, readers));
                }
            }
            Status::WriterLost { guid, .. } | Status::ReaderLost { guid, .. } => {
                self.forget(|endpoint| *endpoint == guid, changes);
            }
            Status::ParticipantLost { id, .. } => self.forget(|endpoint| endpoint.prefix == id, changes),
            Status::WriterDetected { writer } => {
                changes.extend(ros_topic(&writer.topic_name).map(|topic| GraphChange::Writer {
                    topic: topic.to_owned(),
                    type_name: ros_type(&writer.type_name),
                    type_hash: type_hash(&writer.user_data),
                    qos: super::qos::offered(&writer.qos),
                }));
            }
            Status::RemoteWriterQosIncompatible { local_reader, remote_writer, .. } => {
                changes.push(GraphChange::Incompatible { reader: gid(local_reader), writer: gid(remote_writer) });
            }
            _ => {}
        }
    }

    fn forget(&mut self, lost: impl Fn(&GUID) -> bool, changes: &mut Vec<GraphChange>) {
        for (reader, writers) in &mut self.writers_of {
            let gone = remove(writers, &lost);
            if !gone.is_empty() {
                changes.extend(gone.into_iter().map(|writer| presence(*reader, writer, false)));
                changes.push(GraphChange::Matched { reader: gid(*reader), writers: writers.len() });
            }
        }
        for (writer, readers) in &mut self.readers_of {
            if !remove(readers, &lost).is_empty() {
                changes.push(matched_readers(*writer, readers));
            }
        }
    }
}

impl GraphWatch for StatusReader {
    fn take(&mut self) -> Vec<GraphChange> {
        let mut changes = Vec::new();
        while let Some(status) = self.listener.try_recv_status() {
            self.follow(status, &mut changes);
        }
        changes
    }
}

fn presence(reader: GUID, writer: GUID, is_there: bool) -> GraphChange {
    GraphChange::Presence { reader: gid(reader), writer: gid(writer), is_there }
}

fn matched_readers(writer: GUID, readers: &BTreeSet<GUID>) -> GraphChange {
    GraphChange::Readers { writer: gid(writer), readers: readers.iter().copied().map(gid).collect() }
}

/// What ROS 2 says of a topic's type beside its name: `typehash=RIHS01_...;` among the user data.
fn type_hash(user_data: &[u8]) -> String {
    let text = String::from_utf8_lossy(user_data);
    let mut entries = text.split(';');
    entries.find_map(|entry| entry.trim().strip_prefix("typehash=")).unwrap_or_default().to_owned()
}

fn remove(endpoints: &mut BTreeSet<GUID>, lost: &impl Fn(&GUID) -> bool) -> BTreeSet<GUID> {
    endpoints.extract_if(.., |endpoint| lost(endpoint)).collect()
}

impl event::Source for StatusReader {
    fn register(&mut self, registry: &Registry, token: Token, interests: Interest) -> io::Result<()> {
        self.listener.register(registry, token, interests)
    }

    fn reregister(&mut self, registry: &Registry, token: Token, interests: Interest) -> io::Result<()> {
        self.listener.reregister(registry, token, interests)
    }

    fn deregister(&mut self, registry: &Registry) -> io::Result<()> {
        self.listener.deregister(registry)
    }
}

#[cfg(test)]
mod tests {
    use super::type_hash;

    #[test]
    fn type_hashes_are_found_among_user_data() {
        let check = |user_data: &[u8], expected: &str| assert_eq!(type_hash(user_data), expected);
        check(b"typehash=RIHS01_ab;", "RIHS01_ab");
        check(b"enclave=/; typehash=RIHS01_cd;", "RIHS01_cd");
        check(b"enclave=/;", "");
        check(b"\xff\xfe", "");
    }
}
