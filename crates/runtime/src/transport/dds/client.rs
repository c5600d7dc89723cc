//! The calling end of a service.

use super::reader::DdsReader;
use super::writer::DdsWriter;
use crate::transport::network::{Congested, Gid, NetworkReader, NetworkWriter, ServiceClient};
use rustdds::bytes::Bytes;
use rustdds::mio1::{Interest, Registry, Token, event};
use std::collections::BTreeSet;
use std::io;

/// Sends requests and takes their responses.
pub(crate) struct DdsClient {
    responses: DdsReader,
    requests: DdsWriter,
    servers_read: bool,
    servers_write: bool,
}

impl DdsClient {
    pub(super) fn new(requests: DdsWriter, responses: DdsReader) -> Self {
        Self { responses, requests, servers_read: false, servers_write: false }
    }
}

impl ServiceClient for DdsClient {
    fn clear_wakeup(&self) {
        self.responses.clear_wakeup();
    }

    fn is_ready(&self) -> bool {
        self.servers_read && self.servers_write
    }

    fn call(&mut self, request: Bytes) -> Result<u64, Congested> {
        self.requests.write(request)
    }

    fn take(&mut self) -> Option<Result<(u64, Bytes), String>> {
        loop {
            let sample = match self.responses.take_identified()? {
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

    fn readers_changed(&mut self, writer: &Gid, readers: &BTreeSet<Gid>) {
        if *writer == self.requests.gid() {
            self.servers_read = !readers.is_empty();
        }
    }

    fn writers_changed(&mut self, reader: &Gid, writers: usize) {
        if *reader == self.responses.gid() {
            self.servers_write = writers > 0;
        }
    }

    fn flush(&mut self) -> bool {
        self.requests.flush()
    }
}

impl event::Source for DdsClient {
    fn register(&mut self, registry: &Registry, token: Token, interests: Interest) -> io::Result<()> {
        self.responses.register(registry, token, interests)
    }

    fn reregister(&mut self, registry: &Registry, token: Token, interests: Interest) -> io::Result<()> {
        self.responses.reregister(registry, token, interests)
    }

    fn deregister(&mut self, registry: &Registry) -> io::Result<()> {
        self.responses.deregister(registry)
    }
}
