//! The calling end of a service.

use super::reader::NetworkReader;
use super::writer::{Congested, NetworkWriter};
use rustdds::GUID;
use rustdds::bytes::Bytes;
use std::collections::BTreeSet;

/// Sends requests and takes their responses.
pub(crate) struct ServiceClient {
    pub(crate) responses: NetworkReader,
    requests: NetworkWriter,
    servers_read: bool,
    servers_write: bool,
}

impl ServiceClient {
    pub(super) fn new(requests: NetworkWriter, responses: NetworkReader) -> Self {
        Self { responses, requests, servers_read: false, servers_write: false }
    }

    /// Follows who reads the requests.
    pub(crate) fn readers_changed(&mut self, writer: GUID, readers: &BTreeSet<GUID>) {
        if writer == self.requests.guid() {
            self.servers_read = !readers.is_empty();
        }
    }

    /// Follows who writes responses.
    pub(crate) fn writers_changed(&mut self, reader: GUID, writers: usize) {
        if reader == self.responses.guid() {
            self.servers_write = writers > 0;
        }
    }

    /// Whether a server is there, both to hear and to answer.
    pub(crate) fn is_ready(&self) -> bool {
        self.servers_read && self.servers_write
    }

    /// Sends a request (CDR with its header) and gives its count.
    pub(crate) fn call(&mut self, request: Bytes) -> Result<u64, Congested> {
        self.requests.write(request)
    }

    /// The next response to one of our own requests with that request's count, or what is wrong with it.
    pub(crate) fn take(&self) -> Option<Result<(u64, Bytes), String>> {
        loop {
            let sample = match self.responses.take()? {
                Ok(sample) => sample,
                Err(problem) => return Some(Err(problem)),
            };
            // Responses to all clients of a service share one topic.
            let ours = sample.related.filter(|related| related.writer_guid == self.requests.guid());
            if let Some(count) = ours.and_then(|related| u64::try_from(i64::from(related.sequence_number)).ok()) {
                return Some(Ok((count, sample.cdr)));
            }
        }
    }

    /// Sends what waits; true when nothing waits any longer.
    pub(crate) fn flush(&mut self) -> bool {
        self.requests.flush()
    }
}
