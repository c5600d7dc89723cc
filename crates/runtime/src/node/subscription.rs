//! A topic that the node reads.

use crate::transport::Delivered;
use crate::transport::dds::{NetworkReader, NetworkSample, TopicName};
use crate::transport::shared_memory::{Host, SharedReader, SharedTopic};
use rustdds::mio1::{Registry, Token};
use std::collections::VecDeque;
use trench_core::{Qos, Reliability, Source, Steady};

/// How often, and for how long after a writer was seen, shared memory is looked for.
const RETRY_SECONDS: f64 = 0.2;
const RETRIES: u32 = 25;

/// Both ends of the same subscription: this host's and the network's.
pub(crate) struct Subscription {
    topic: String,
    network_name: TopicName,
    shared_name: SharedTopic,
    qos: Qos,
    pub(crate) network: NetworkReader,
    local: Option<SharedReader>,
    local_token: Token,
    retry: Option<(Steady, u32)>,
    delivered: Delivered,
}

/// What a subscription reads.
pub(crate) struct Reading {
    /// The absolute name.
    pub(crate) topic: String,
    /// As the network names topic and type.
    pub(crate) network_name: TopicName,
    /// As shared memory names them.
    pub(crate) shared_name: SharedTopic,
    /// What the node asked for.
    pub(crate) qos: Qos,
}

impl Subscription {
    pub(crate) fn new(reading: Reading, network: NetworkReader, local_token: Token) -> Self {
        let Reading { topic, network_name, shared_name, qos } = reading;
        let retry = Some((Steady(0), 1));
        let delivered = Delivered::default();
        Self { topic, network_name, shared_name, qos, network, local: None, local_token, retry, delivered }
    }

    /// The absolute name.
    pub(crate) fn topic(&self) -> &str {
        &self.topic
    }

    /// How the network names topic and type.
    pub(crate) fn network_name(&self) -> &TopicName {
        &self.network_name
    }

    /// How many messages of a reliable writer went missing since the last call: it sent faster than this node reads.
    pub(crate) fn take_lost(&mut self) -> u64 {
        let lost = self.delivered.take_lost();
        if self.qos.reliability == Reliability::Reliable { lost } else { 0 }
    }

    /// Looks for shared memory anew: somebody writes the topic.
    pub(crate) fn look_for_writer(&mut self) {
        if self.local.is_none() {
            self.retry = Some((Steady(0), RETRIES));
        }
    }

    /// When [`Subscription::open_local`] should be called.
    pub(crate) fn next_retry(&self) -> Option<Steady> {
        self.retry.map(|(at, _)| at)
    }

    /// Opens the topic's shared memory if it is time to and a process of this host offers it; true when it did.
    pub(crate) fn open_local(&mut self, now: Steady, host: &Host, registry: &Registry) -> Result<bool, String> {
        let Some((at, left)) = self.retry else { return Ok(false) };
        if at > now {
            return Ok(false);
        }
        self.retry = (left > 1).then(|| (now.plus_seconds(RETRY_SECONDS), left - 1));
        self.local =
            host.reader(&self.shared_name, self.qos, registry, self.local_token).map_err(|error| error.to_string())?;
        if self.local.is_some() {
            self.retry = None;
        }
        Ok(self.local.is_some())
    }

    /// Gives all waiting messages to `deliver`, each once and in order; what cannot be read goes to `report`.
    ///
    /// A writer hands a message to shared memory before the network. So whatever the network has and shared memory had
    /// not a moment ago may be there now: it is looked at once more before the network's copy is taken.
    pub(crate) fn drain(&mut self, mut deliver: impl FnMut(Source, &[u8]), mut report: impl FnMut(String)) {
        self.network.clear_wakeup();
        let mut waiting = VecDeque::new();
        while let Some(taken) = self.network.take() {
            match taken {
                Ok(sample) => keep(&mut waiting, sample, self.qos),
                Err(problem) => report(problem),
            }
        }
        self.drain_local(&mut deliver, &mut report);
        for NetworkSample { source, cdr, .. } in waiting {
            if self.delivered.accept(source) {
                deliver(source, &cdr);
            }
        }
    }

    fn drain_local(&mut self, deliver: &mut impl FnMut(Source, &[u8]), report: &mut impl FnMut(String)) {
        let Some(local) = &self.local else { return };
        local.clear_wakeup();
        while let Some(taken) = local.take() {
            match taken {
                Ok(sample) if self.delivered.accept(sample.source()) => deliver(sample.source(), sample.cdr()),
                Ok(_copy) => {}
                Err(problem) => {
                    report(problem);
                    return;
                }
            }
        }
    }
}

fn keep(waiting: &mut VecDeque<NetworkSample>, sample: NetworkSample, qos: Qos) {
    // A best-effort reader wants the newest samples, not those that piled up before them.
    if qos.reliability == Reliability::BestEffort && waiting.len() >= qos.depth.max(1) {
        waiting.pop_front();
    }
    waiting.push_back(sample);
}
