//! The serving end of a service, in the "enhanced" mapping of DDS-RPC that ROS 2's Fast DDS uses.

use super::reader::NetworkReader;
use super::writer::{LONGEST_RELATED, NetworkWriter};
use rustdds::bytes::Bytes;
use rustdds::{DomainParticipant, GUID, SampleIdentity, SequenceNumber};
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

/// Why a response was not sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(crate) enum NotSent {
    /// The clients acknowledge nothing any more.
    #[error("its clients are more than 8192 responses behind")]
    Congested,
    /// RustDDS 0.15.1 would cut it up and garble it.
    #[error(
        "its {0} bytes need more than one datagram: ask for less at once, or announce loopback alone \
         (FASTDDS_DEFAULT_PROFILES_FILE=config/fastdds_loopback.xml)"
    )]
    TooLong(usize),
}

/// Takes requests and sends responses.
pub(crate) struct ServiceServer {
    pub(crate) requests: NetworkReader,
    responses: NetworkWriter,
    participant: DomainParticipant,
    readers: BTreeSet<GUID>,
    held: Vec<Held>,
}

impl ServiceServer {
    pub(super) fn new(requests: NetworkReader, responses: NetworkWriter, participant: DomainParticipant) -> Self {
        Self { requests, responses, participant, readers: BTreeSet::new(), held: Vec::new() }
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
    pub(crate) fn respond(&mut self, request: PendingRequest, response: Bytes) -> Result<(), NotSent> {
        if self.reaches(request) {
            return self.send(request, response);
        }
        self.held.push(Held { request, response, until: Instant::now() + DISCOVERY });
        Ok(())
    }

    fn send(&mut self, request: PendingRequest, response: Bytes) -> Result<(), NotSent> {
        if response.len() > LONGEST_RELATED && !self.all_read_on_loopback() {
            return Err(NotSent::TooLong(response.len()));
        }
        self.responses.write_related(response, request.0).map(|_| ()).map_err(|_congested| NotSent::Congested)
    }

    /// Whether all readers of the responses announce loopback alone, whose datagrams hold 64 kB. A response goes to all.
    fn all_read_on_loopback(&self) -> bool {
        let found = self.participant.discovered_readers();
        self.readers.iter().all(|reader| {
            let found = found.iter().map(|found| &found.reader_proxy).find(|found| found.remote_reader_guid == *reader);
            let places = found.map(|found| &found.unicast_locator_list[..]).unwrap_or_default();
            !places.is_empty() && places.iter().all(|place| place.is_loopback())
        })
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
                // The client is there now or never. It asked before it was known: nobody is told if this is not sent.
                let _not_sent = self.send(held.request, held.response);
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
