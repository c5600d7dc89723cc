//! The calling end of a service.

use super::reader::NetworkReader;
use super::writer::{Congested, NetworkWriter};
use rustdds::bytes::Bytes;

/// Sends requests and takes their responses.
pub(crate) struct ServiceClient {
    pub(crate) responses: NetworkReader,
    requests: NetworkWriter,
}

impl ServiceClient {
    pub(super) fn new(requests: NetworkWriter, responses: NetworkReader) -> Self {
        Self { responses, requests }
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
