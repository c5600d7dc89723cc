//! A topic that the node writes.

use crate::transport::dds::NetworkWriter;
use crate::transport::shared_memory::SharedWriter;
use rustdds::bytes::Bytes;
use std::time::Duration;
use trench_core::Source;

/// Both ends of the same publication: this host's and the network's.
pub(crate) struct Publication {
    topic: String,
    network: NetworkWriter,
    /// False where only readers of this host get the messages.
    to_network: bool,
    local: Option<SharedWriter>,
    sent: u64,
    refused: u64,
}

/// Why a message was not published as it should.
#[derive(Debug)]
pub(crate) enum PublishProblem {
    /// The network is too far behind to take it; nobody got it.
    Congested,
    /// Shared memory failed; readers get it from the network, if it goes there.
    SharedMemory(String),
}

impl Publication {
    /// To the network alone, unless [`Publication::share`] follows.
    pub(crate) fn new(topic: String, network: NetworkWriter) -> Self {
        Self { topic, network, to_network: true, local: None, sent: 0, refused: 0 }
    }

    /// Serves readers of this host through shared memory, and others only if `to_network`.
    pub(crate) fn share(&mut self, local: SharedWriter, to_network: bool) {
        self.local = Some(local);
        self.to_network = to_network;
    }

    /// Publishes what `fill` writes into `max_len` bytes.
    pub(crate) fn publish_with(
        &mut self,
        max_len: usize,
        fill: &mut dyn FnMut(&mut [u8]) -> usize,
    ) -> Result<(), PublishProblem> {
        if self.to_network && !self.network.has_room() {
            self.refused += 1;
            return Err(PublishProblem::Congested);
        }
        let (message, problem) = match &self.local {
            Some(local) => self.publish_locally(local, max_len, fill),
            None => (Some(encode(max_len, fill)), None),
        };
        self.sent += 1;
        if let Some(message) = message {
            self.network.write(message).map_err(|_congested| PublishProblem::Congested)?;
        }
        problem.map_or(Ok(()), |problem| Err(PublishProblem::SharedMemory(problem)))
    }

    /// Writes into shared memory; gives what the network gets.
    fn publish_locally(
        &self,
        local: &SharedWriter,
        max_len: usize,
        fill: &mut dyn FnMut(&mut [u8]) -> usize,
    ) -> (Option<Bytes>, Option<String>) {
        let source = Source { gid: self.network.gid(), sequence: self.sent + 1 };
        let mut network_copy = None;
        let copy = |message: &[u8]| {
            if self.to_network {
                network_copy = Some(Bytes::copy_from_slice(message));
            }
        };
        match local.publish_with(source, max_len, fill, copy) {
            Ok(()) => (network_copy, None),
            Err(problem) => (network_copy.or_else(|| self.to_network.then(|| encode(max_len, fill))), Some(problem)),
        }
    }

    /// The absolute name.
    pub(crate) fn topic(&self) -> &str {
        &self.topic
    }

    /// How many messages the network did not take.
    pub(crate) fn refused(&self) -> u64 {
        self.refused
    }

    /// Waits until the readers have everything, or time is over.
    pub(crate) fn settle(&mut self, max_wait: Duration) {
        self.network.settle(max_wait);
    }

    /// Sends what waits; true when nothing waits any longer.
    pub(crate) fn flush(&mut self) -> bool {
        self.network.flush()
    }
}

fn encode(max_len: usize, fill: &mut dyn FnMut(&mut [u8]) -> usize) -> Bytes {
    let mut message = vec![0; max_len];
    let length = fill(&mut message);
    message.truncate(length);
    message.into()
}
