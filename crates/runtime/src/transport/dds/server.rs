//! The serving end of a service, in the "enhanced" mapping of DDS-RPC that ROS 2's Fast DDS uses.

use super::reader::NetworkReader;
use super::writer::{Congested, NetworkWriter};
use rustdds::bytes::Bytes;
use rustdds::{GUID, SampleIdentity, SequenceNumber};
use std::collections::BTreeSet;
use std::time::{Duration, Instant};

/// How long a response waits for its client's reader to be discovered: requests can come before it.
const DISCOVERY: Duration = Duration::from_millis(1000);

/// Whom to answer.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PendingRequest(SampleIdentity);

/// A response whose client cannot be reached yet.
struct Held {
    request: PendingRequest,
    response: Bytes,
    until: Instant,
}

/// Takes requests and sends responses.
pub(crate) struct ServiceServer {
    pub(crate) requests: NetworkReader,
    responses: NetworkWriter,
    readers: BTreeSet<GUID>,
    held: Vec<Held>,
}

impl ServiceServer {
    pub(super) fn new(requests: NetworkReader, responses: NetworkWriter) -> Self {
        Self { requests, responses, readers: BTreeSet::new(), held: Vec::new() }
    }

    /// The next request (CDR with its header), or what is wrong with it.
    pub(crate) fn take(&self) -> Option<Result<(PendingRequest, Bytes), String>> {
        let sample = match self.requests.take()? {
            Ok(sample) => sample,
            Err(problem) => return Some(Err(problem)),
        };
        let mut request = sample.related.unwrap_or(sample.identity);
        // Fast DDS names the client's reader but leaves the count to be taken from the request itself.
        if request.sequence_number == SequenceNumber::UNKNOWN {
            request.sequence_number = sample.identity.sequence_number;
        }
        Some(Ok((PendingRequest(request), sample.cdr)))
    }

    /// Answers a request.
    pub(crate) fn respond(&mut self, request: PendingRequest, response: Bytes) -> Result<(), Congested> {
        if self.reaches(request) {
            return self.responses.write_related(response, request.0).map(|_| ());
        }
        self.held.push(Held { request, response, until: Instant::now() + DISCOVERY });
        Ok(())
    }

    /// Follows who reads the responses.
    pub(crate) fn readers_changed(&mut self, writer: GUID, readers: &BTreeSet<GUID>) {
        if writer == self.responses.guid() {
            self.readers.clone_from(readers);
        }
    }

    /// Sends what waits; true when nothing waits any longer.
    pub(crate) fn flush(&mut self) -> bool {
        let now = Instant::now();
        for held in std::mem::take(&mut self.held) {
            if self.reaches(held.request) || held.until <= now {
                // The client is there now or never; a full network loses it like any other response.
                let _congested = self.responses.write_related(held.response, held.request.0);
            } else {
                self.held.push(held);
            }
        }
        self.responses.flush() && self.held.is_empty()
    }

    /// Whether the client's process has a reader of our responses.
    fn reaches(&self, request: PendingRequest) -> bool {
        self.readers.iter().any(|reader| reader.prefix == request.0.writer_guid.prefix)
    }
}
