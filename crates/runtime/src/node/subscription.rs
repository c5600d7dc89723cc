//! A topic that the node reads.

use crate::transport::Delivered;
use crate::transport::dds::{NetworkReader, NetworkSample, TopicName};
use std::collections::VecDeque;
use trench_core::{Reliability, Source, Subscribe};

/// Both ends of the same subscription: this host's and the network's.
pub(crate) struct Subscription {
    topic: String,
    network_name: TopicName,
    newest: Option<usize>,
    pub(crate) network: NetworkReader,
    delivered: Delivered,
}

impl Subscription {
    pub(crate) fn new(topic: String, network_name: TopicName, network: NetworkReader, subscribe: &Subscribe) -> Self {
        // A best-effort reader wants the newest samples, not those that piled up before them.
        let newest = (subscribe.qos.reliability == Reliability::BestEffort).then_some(subscribe.qos.depth.max(1));
        Self { topic, network_name, newest, network, delivered: Delivered::default() }
    }

    /// The absolute name.
    pub(crate) fn topic(&self) -> &str {
        &self.topic
    }

    /// How the network names topic and type.
    pub(crate) fn network_name(&self) -> &TopicName {
        &self.network_name
    }

    /// Gives all waiting messages to `deliver`, each once and in order; what cannot be read goes to `report`.
    pub(crate) fn drain(&mut self, mut deliver: impl FnMut(Source, &[u8]), mut report: impl FnMut(String)) {
        self.network.clear_wakeup();
        let mut waiting = VecDeque::new();
        while let Some(taken) = self.network.take() {
            match taken {
                Ok(sample) => keep(&mut waiting, sample, self.newest),
                Err(problem) => report(problem),
            }
        }
        for NetworkSample { source, cdr, .. } in waiting {
            if self.delivered.accept(source) {
                deliver(source, &cdr);
            }
        }
    }
}

fn keep(waiting: &mut VecDeque<NetworkSample>, sample: NetworkSample, newest: Option<usize>) {
    if newest.is_some_and(|depth| waiting.len() >= depth) {
        waiting.pop_front();
    }
    waiting.push_back(sample);
}
