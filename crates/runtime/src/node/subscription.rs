//! A topic that the node reads.

use super::early::Early;
use crate::transport::Delivered;
use crate::transport::network::{NetworkReader, NetworkSample, TopicName};
use crate::transport::shared_memory::{Host, SharedReader, SharedSample, SharedTopic};
use rustdds::mio1::{Registry, Token};
use std::collections::VecDeque;
use trench_core::{Durability, Qos, Reliability, Source, Steady, Subscribe};

/// How often, and for how long after a writer was seen, shared memory is looked for.
const RETRY_SECONDS: f64 = 0.2;
const RETRIES: u32 = 25;

/// How long messages that shared memory missed may take over the network, whose repairs come every 0.1 s.
const GAP_SECONDS: f64 = 0.3;

/// Both ends of the same subscription: this host's and the network's.
pub(crate) struct Subscription {
    name: TopicName,
    shared_name: SharedTopic,
    qos: Qos,
    pub(crate) network: Box<dyn NetworkReader>,
    /// Whether the network may have brought something: asking it in vain costs system calls.
    network_woke: bool,
    local: Option<SharedReader>,
    /// What shared memory wakes the loop by; none where messages wait for the next event.
    local_token: Option<Token>,
    retry: Option<(Steady, u32)>,
    delivered: Delivered,
    /// A message of shared memory that waits, until some time, for the network to bring those before it.
    pending: Option<(SharedSample, Steady)>,
    early: Early,
}

/// Whose message it is, and when it was written on this host or the network brought it.
type Arrival = (Source, Steady);

/// What a subscription reads.
pub(crate) struct Reading {
    /// Topic and type.
    pub(crate) name: TopicName,
    /// As shared memory names them.
    pub(crate) shared_name: SharedTopic,
    /// What the node asked for.
    pub(crate) qos: Qos,
}

impl Subscription {
    pub(crate) fn new(reading: Reading, network: Box<dyn NetworkReader>, local_token: Option<Token>) -> Self {
        let Reading { name, shared_name, qos } = reading;
        let retry = Some((Steady(0), 1));
        let delivered = Delivered::default();
        Self {
            name,
            shared_name,
            qos,
            network,
            network_woke: true,
            local: None,
            local_token,
            retry,
            delivered,
            pending: None,
            early: Early::default(),
        }
    }

    /// The network has brought something.
    pub(crate) fn network_wakes(&mut self) {
        self.network_woke = true;
    }

    /// Whether a message wakes the loop.
    pub(crate) fn wakes(&self) -> bool {
        self.local_token.is_some()
    }

    /// The absolute name.
    pub(crate) fn topic(&self) -> &str {
        self.name.topic()
    }

    /// Whether it is what `subscribe` asks for under the absolute name `topic`.
    pub(crate) fn reads(&self, topic: &str, subscribe: &Subscribe) -> bool {
        let same_type = self.name.type_name() == subscribe.type_info.name;
        self.topic() == topic && same_type && self.qos == subscribe.qos && self.wakes() == subscribe.wakes
    }

    /// The type that is read.
    pub(crate) fn type_name(&self) -> &'static str {
        self.name.type_name()
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

    /// When [`Subscription::open_local`] or [`Subscription::drain`] should be called.
    pub(crate) fn next_retry(&self) -> Option<Steady> {
        self.retry.map(|(at, _)| at).into_iter().chain(self.next_release()).min()
    }

    /// Opens the topic's shared memory if it is time to and a process of this host offers it; true when it did.
    pub(crate) fn open_local(&mut self, now: Steady, host: &Host, registry: &Registry) -> Result<bool, String> {
        let Some((at, left)) = self.retry else { return Ok(false) };
        if at > now {
            return Ok(false);
        }
        self.retry = (left > 1).then(|| (now.plus_seconds(RETRY_SECONDS), left - 1));
        self.local = host
            .reader(&self.shared_name, self.qos, self.network.gid(), registry, self.local_token)
            .map_err(|error| error.to_string())?;
        if self.local.is_some() {
            self.retry = None;
        }
        Ok(self.local.is_some())
    }

    /// Whether time alone makes [`Subscription::drain`] give messages now.
    pub(crate) fn is_due(&self, now: Steady) -> bool {
        self.next_release().is_some_and(|at| at <= now)
    }

    fn next_release(&self) -> Option<Steady> {
        let pending = self.pending.as_ref().map(|(_, until)| *until);
        self.early.until().into_iter().chain(pending).min()
    }

    /// Gives all waiting messages to `deliver`, each once and in order; what cannot be read goes to `report`.
    ///
    /// A writer hands a message to shared memory before the network. So shared memory is looked at after the network
    /// was, and before the network's copies are taken.
    pub(crate) fn drain(
        &mut self,
        now: Steady,
        mut deliver: impl FnMut(Arrival, &[u8]),
        mut report: impl FnMut(String),
    ) {
        let is_due = self.is_due(now);
        let waiting = if self.network_woke || is_due { self.drain_network(&mut report) } else { VecDeque::new() };
        if let Some(local) = &self.local {
            local.clear_wakeup();
        }
        self.drain_local(now, &mut deliver, &mut report);
        if waiting.is_empty() && !is_due {
            return;
        }
        for sample in waiting {
            if self.qos.durability == Durability::TransientLocal && !self.delivered.knows(&sample.source.gid) {
                self.early.keep(sample, self.qos.depth, now);
            } else {
                self.take_network(&sample, &mut deliver);
            }
        }
        if self.early.until().is_some_and(|until| until <= now) {
            self.release_early(&mut deliver);
        }
        // The network may have brought what shared memory was waiting for.
        self.drain_local(now, &mut deliver, &mut report);
    }

    /// What the network has brought.
    fn drain_network(&mut self, report: &mut impl FnMut(String)) -> VecDeque<NetworkSample> {
        self.network_woke = false;
        self.network.clear_wakeup();
        let mut waiting = VecDeque::new();
        while let Some(taken) = self.network.take() {
            match taken {
                Ok(sample) => keep(&mut waiting, sample, self.qos),
                Err(problem) => report(problem),
            }
        }
        waiting
    }

    fn take_network(&mut self, sample: &NetworkSample, deliver: &mut impl FnMut(Arrival, &[u8])) {
        self.delivered.heard_over_network(sample.source);
        if self.delivered.accept(sample.source) {
            deliver((sample.source, sample.arrived), &sample.cdr);
        }
    }

    fn release_early(&mut self, deliver: &mut impl FnMut(Arrival, &[u8])) {
        for sample in self.early.release() {
            self.take_network(&sample, deliver);
        }
    }

    fn drain_local(&mut self, now: Steady, deliver: &mut impl FnMut(Arrival, &[u8]), report: &mut impl FnMut(String)) {
        while let Some((taken, until)) = self.next_local(now) {
            let sample = match taken {
                Ok(sample) => sample,
                Err(problem) => {
                    // The network goes on as soon as the writer sees that this reader is gone from shared memory.
                    self.local = None;
                    self.look_for_writer();
                    return report(problem);
                }
            };
            if !self.delivered.is_new(sample.source()) {
                continue;
            }
            let reliable = self.qos.reliability == Reliability::Reliable;
            if reliable && self.delivered.may_be_filled(sample.source()) {
                if now < until {
                    // A reader that has just found shared memory is ahead of the network's last messages.
                    self.pending = Some((sample, until));
                    return;
                }
                self.delivered.give_up(&sample.source().gid);
            }
            if self.early.holds(&sample.source().gid) {
                self.release_early(deliver);
            }
            if self.delivered.accept(sample.source()) {
                deliver((sample.source(), sample.written()), sample.cdr());
            }
        }
    }

    /// The next message of shared memory and how long it may wait for those before it.
    fn next_local(&mut self, now: Steady) -> Option<(Result<SharedSample, String>, Steady)> {
        if let Some((sample, until)) = self.pending.take() {
            return Some((Ok(sample), until));
        }
        Some((self.local.as_ref()?.take()?, now.plus_seconds(GAP_SECONDS)))
    }
}

fn keep(waiting: &mut VecDeque<NetworkSample>, sample: NetworkSample, qos: Qos) {
    // A best-effort reader wants the newest samples, not those that piled up before them.
    if qos.reliability == Reliability::BestEffort && waiting.len() >= qos.depth.max(1) {
        waiting.pop_front();
    }
    waiting.push_back(sample);
}
