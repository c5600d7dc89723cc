//! The serving end of a service, in the "enhanced" mapping of DDS-RPC that ROS 2's Fast DDS uses.

use super::long;
use super::longest::longest_annotated;
use super::reader::DdsReader;
use super::writer::{DdsWriter, gid};
use crate::transport::network::{Gid, NetworkReader, NetworkWriter, NotSent, PendingRequest, ServiceServer};
use rustdds::bytes::Bytes;
use rustdds::mio1::{Interest, Registry, Token, event};
use rustdds::{DomainParticipant, GUID, SampleIdentity, SequenceNumber};
use std::collections::BTreeSet;
use std::io;
use std::net::SocketAddr;
use std::time::{Duration, Instant};

/// How long a response waits for its client's reader to be discovered: requests can come before it.
const DISCOVERY: Duration = Duration::from_millis(1000);

/// A response whose client cannot be reached yet.
struct Held {
    request: SampleIdentity,
    response: Bytes,
    until: Instant,
}

/// Takes requests and sends responses.
pub(crate) struct DdsServer {
    requests: DdsReader,
    responses: DdsWriter,
    participant: DomainParticipant,
    readers: BTreeSet<Gid>,
    held: Vec<Held>,
    /// Whether what is sent is protected, as what goes beside RustDDS is not.
    is_secured: bool,
}

impl DdsServer {
    pub(super) fn new(
        requests: DdsReader,
        responses: DdsWriter,
        participant: DomainParticipant,
        is_secured: bool,
    ) -> Self {
        Self { requests, responses, participant, readers: BTreeSet::new(), held: Vec::new(), is_secured }
    }

    fn send(&mut self, request: SampleIdentity, response: Bytes) -> Result<(), NotSent> {
        let written = if response.len() > longest_annotated() {
            self.send_long(request, &response)?;
            self.responses.write(Bytes::from_static(long::PLACEHOLDER))
        } else {
            self.responses.write_related(response, request)
        };
        written.map(|_| ()).map_err(|_congested| NotSent::Congested)
    }

    /// Sends what does not fit a datagram of an Ethernet to the client alone, as the next message of our writer.
    fn send_long(&self, request: SampleIdentity, response: &Bytes) -> Result<(), NotSent> {
        if response.len() > long::LONGEST || self.is_secured {
            return Err(NotSent::TooLong(response.len()));
        }
        let number = self.responses.next_number().ok_or(NotSent::Congested)?;
        let sample = long::Sample { writer: self.responses.guid(), number, related: request, cdr: response };
        for found in self.participant.discovered_readers() {
            let reader = found.reader_proxy.remote_reader_guid;
            if self.readers.contains(&gid(reader)) && reader.prefix == request.writer_guid.prefix {
                let places = found.reader_proxy.unicast_locator_list.into_iter().filter(|place| place.is_udp());
                long::send(&sample, reader, places.map(SocketAddr::from))
                    .map_err(|error| NotSent::Network(error.kind()))?;
            }
        }
        Ok(())
    }

    /// Whether the client's process has a reader of our responses.
    fn reaches(&self, request: SampleIdentity) -> bool {
        self.readers.iter().any(|reader| GUID::from_bytes(*reader).prefix == request.writer_guid.prefix)
    }
}

impl ServiceServer for DdsServer {
    fn clear_wakeup(&self) {
        self.requests.clear_wakeup();
    }

    fn take(&mut self) -> Option<Result<(PendingRequest, Bytes), String>> {
        let sample = match self.requests.take_identified()? {
            Ok(sample) => sample,
            Err(problem) => return Some(Err(problem)),
        };
        let mut request = sample.related.unwrap_or(sample.identity);
        // Fast DDS names the client's reader but leaves the count to be taken from the request itself.
        if request.sequence_number == SequenceNumber::UNKNOWN {
            request.sequence_number = sample.identity.sequence_number;
        }
        let pending = PendingRequest { client: gid(request.writer_guid), count: request.sequence_number.into() };
        Some(Ok((pending, sample.cdr)))
    }

    fn respond(&mut self, request: PendingRequest, response: Bytes) -> Result<(), NotSent> {
        let sequence_number = SequenceNumber::from(request.count);
        let request = SampleIdentity { writer_guid: GUID::from_bytes(request.client), sequence_number };
        if self.reaches(request) {
            return self.send(request, response);
        }
        self.held.push(Held { request, response, until: Instant::now() + DISCOVERY });
        Ok(())
    }

    fn readers_changed(&mut self, writer: &Gid, readers: &BTreeSet<Gid>) {
        if *writer == self.responses.gid() {
            self.readers.clone_from(readers);
        }
    }

    fn flush(&mut self) -> bool {
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
}

impl event::Source for DdsServer {
    fn register(&mut self, registry: &Registry, token: Token, interests: Interest) -> io::Result<()> {
        self.requests.register(registry, token, interests)
    }

    fn reregister(&mut self, registry: &Registry, token: Token, interests: Interest) -> io::Result<()> {
        self.requests.reregister(registry, token, interests)
    }

    fn deregister(&mut self, registry: &Registry) -> io::Result<()> {
        self.requests.deregister(registry)
    }
}
