//! The serving end of a service, in the "enhanced" mapping of DDS-RPC that ROS 2's Fast DDS uses.

use super::reader::NetworkReader;
use super::writer::{Congested, NetworkWriter};
use rustdds::bytes::Bytes;
use rustdds::{SampleIdentity, SequenceNumber};

/// Whom to answer.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PendingRequest(SampleIdentity);

/// Takes requests and sends responses.
pub(crate) struct ServiceServer {
    pub(crate) requests: NetworkReader,
    responses: NetworkWriter,
}

impl ServiceServer {
    pub(super) fn new(requests: NetworkReader, responses: NetworkWriter) -> Self {
        Self { requests, responses }
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
        self.responses.write_related(response, request.0).map(|_| ())
    }

    /// Sends what waits; true when nothing waits any longer.
    pub(crate) fn flush(&mut self) -> bool {
        self.responses.flush()
    }
}
