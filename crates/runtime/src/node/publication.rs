//! A topic that the node writes.

use crate::transport::dds::NetworkWriter;
use std::time::Duration;
use trench_core::Advertise;

/// Both ends of the same publication: this host's and the network's.
pub(crate) struct Publication {
    topic: String,
    network: NetworkWriter,
    refused: u64,
}

impl Publication {
    pub(crate) fn new(topic: String, network: NetworkWriter, _advertise: &Advertise) -> Self {
        Self { topic, network, refused: 0 }
    }

    /// Publishes what `fill` writes into `max_len` bytes; false if the network is too far behind to take it.
    pub(crate) fn publish_with(&mut self, max_len: usize, fill: &mut dyn FnMut(&mut [u8]) -> usize) -> bool {
        let mut message = vec![0; max_len];
        let length = fill(&mut message);
        message.truncate(length);
        let taken = self.network.write(message.into()).is_ok();
        self.refused += u64::from(!taken);
        taken
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
