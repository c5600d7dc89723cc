//! A topic that the node writes.

use super::audience::Audience;
use super::held::Held;
use crate::transport::network::{Gid, NetworkWriter};
use crate::transport::shared_memory::SharedWriter;
use rustdds::bytes::Bytes;
use std::collections::BTreeSet;
use std::time::Duration;
use trench_core::{Durability, Qos, Reliability, Source, Steady};

/// Both ends of the same publication: this host's and the network's.
pub(crate) struct Publication {
    topic: String,
    qos: Qos,
    network: Box<dyn NetworkWriter>,
    local: Option<Local>,
    /// False where only readers of this host get the messages.
    to_network: bool,
    /// Whether the network has found a reader.
    is_read: bool,
    /// The last messages of a life go all ways there are.
    last_words: bool,
    sent: u64,
    refused: u64,
}

/// This host's end.
struct Local {
    writer: SharedWriter,
    /// How many readers there were when `audience` was looked at.
    readers: usize,
    audience: Audience,
    held: Held,
    /// Whether the network may ever rest. Readers of latched topics may come later and want the past, which the network
    /// keeps for them; long messages cannot carry the count that the network loses while it rests.
    may_be_alone: bool,
    /// Whether the network rested at the last message.
    alone: bool,
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
    pub(crate) fn new(topic: String, qos: Qos, network: Box<dyn NetworkWriter>) -> Self {
        Self {
            topic,
            qos,
            network,
            local: None,
            to_network: true,
            is_read: false,
            last_words: false,
            sent: 0,
            refused: 0,
        }
    }

    /// Serves readers of this host through shared memory, and others only if `to_network`.
    /// `max_len`: the longest message, bytes.
    pub(crate) fn share(&mut self, writer: SharedWriter, max_len: usize, to_network: bool) {
        let held = Held::new(writer.buffered() / 2);
        let may_be_alone = max_len <= self.network.longest_counted() && self.qos.durability == Durability::Volatile;
        self.local =
            Some(Local { writer, readers: 0, audience: Audience::default(), held, may_be_alone, alone: false });
        self.to_network = to_network;
    }

    /// Follows who reads the topic on the network.
    pub(crate) fn readers_changed(&mut self, writer: &Gid, readers: &BTreeSet<Gid>) {
        if *writer != self.network.gid() {
            return;
        }
        self.is_read = !readers.is_empty();
        let Some(local) = &mut self.local else { return self.network.readers_changed(readers) };
        local.audience.matched(readers.clone());
        // A reader that has just come did not ask for the past.
        local.held.clear();
        self.tell_network();
    }

    /// Tells the network who needs it, where it may help.
    fn tell_network(&mut self) {
        if self.to_network
            && let Some(local) = &self.local
        {
            self.network.readers_changed(&local.audience.beyond());
        }
    }

    /// Images may take so many bit/s of the network.
    pub(crate) fn limit(&mut self, rate: f64) {
        self.network.limit(rate);
    }

    /// From now on every message goes all ways: who speaks them may be gone before they are heard.
    pub(crate) fn say_last_words(&mut self) {
        self.last_words = true;
    }

    /// Publishes what `fill` writes into `max_len` bytes.
    pub(crate) fn publish_with(
        &mut self,
        now: Steady,
        max_len: usize,
        fill: &mut dyn FnMut(&mut [u8]) -> usize,
    ) -> Result<(), PublishProblem> {
        if self.is_unheard() {
            // Counted where the network need not agree, or can be told.
            self.sent += u64::from(self.local.is_some());
            return Ok(());
        }
        if self.to_network && !self.network.has_room() {
            self.refused += 1;
            return Err(PublishProblem::Congested);
        }
        // Before the message is written: a reader that comes meanwhile gets it from the network.
        let alone = self.shares_memory();
        self.sent += 1;
        let Some(local) = &mut self.local else {
            return self.network.write_counted(encode(max_len, fill), self.sent).map_err(|_| PublishProblem::Congested);
        };
        local.alone = alone;
        let source = Source { gid: self.network.gid(), sequence: self.sent };
        let may_be_missed = self.qos.reliability == Reliability::BestEffort;
        // Over Zenoh whoever is about to come may hear what is said before it can be heard of, and would miss what follows.
        let to_network = self.to_network && (self.is_read || self.last_words || !local.may_be_alone);
        let wants_copy = to_network && !(alone && may_be_missed);
        let mut copy = None;
        let keep = |message: &[u8]| copy = wants_copy.then(|| Bytes::copy_from_slice(message));
        let written = local.writer.publish_with(source, max_len, fill, keep);
        let all_woken = written.as_ref().is_ok_and(|all| *all);
        let problem = written.err();
        if problem.is_some() && to_network && copy.is_none() {
            copy = Some(encode(max_len, fill));
        }
        if let Some(message) = copy {
            let burst = local.held.keep(self.sent, message, now);
            if burst || !alone || !all_woken {
                for (count, message) in local.held.release(now) {
                    self.network.write_counted(message, count).map_err(|_congested| PublishProblem::Congested)?;
                }
            }
        }
        problem.map_or(Ok(()), |problem| Err(PublishProblem::SharedMemory(problem)))
    }

    /// Whether nobody would ever hear a message: readers that come later do not ask for the past. Writing it all the
    /// same would cost time, and where it goes over the network wake RustDDS's thread, beside the control loop.
    fn is_unheard(&self) -> bool {
        let nobody_shares = self.local.as_ref().is_none_or(|local| {
            let network_keeps_count = self.to_network && !local.may_be_alone;
            !network_keeps_count && local.writer.readers() == 0
        });
        nobody_shares && !self.is_read && self.qos.durability == Durability::Volatile
    }

    /// Whether shared memory reaches all readers, so that the network may rest.
    fn shares_memory(&mut self) -> bool {
        let Some(local) = &mut self.local else { return false };
        let readers = local.writer.readers();
        let changed = readers != local.readers;
        if changed {
            local.readers = readers;
            local.audience.served(local.writer.gids());
        }
        let shares = local.may_be_alone && !self.last_words && local.audience.shares_memory();
        if changed {
            self.tell_network();
        }
        shares
    }

    /// The absolute name.
    pub(crate) fn topic(&self) -> &str {
        &self.topic
    }

    /// Whether the last message went through shared memory alone although it may go over the network, and to how many
    /// readers there.
    pub(crate) fn alone_with(&self) -> Option<usize> {
        self.local.as_ref().filter(|local| local.alone && self.to_network).map(|local| local.readers)
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
