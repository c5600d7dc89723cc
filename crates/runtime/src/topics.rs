//! The topics that a process reads: each once, however many of its nodes read it.
//!
//! Nodes that ask for the same topic, type and quality of service share both of its ends. A hundred controllers hear
//! each other's leader states by a hundred readers instead of ten thousand, and a message wakes the process once.

use crate::node::{Connections, Node, Subscription};
use crate::rhythm::Rhythm;
use crate::transport::TransportError;
use crate::transport::network::{Gid, GraphChange, NetworkReader};
use crate::transport::shared_memory::Host;
use rustdds::mio1::{Events, Interest, Poll, Registry, Token};
use std::io;
use std::time::Duration;
use trench_core::{Event, RosTime, Steady, Subscribe};
use trench_msgs::Message;
use trench_msgs::rosgraph_msgs::Clock as ClockMessage;

/// Who reads a topic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Listener {
    /// The node's index in the process.
    pub(crate) node: usize,
    pub(crate) what: Heard,
}

/// What a topic is to a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Heard {
    /// `Interface::subscriptions[port]` of its core.
    Port(usize),
    /// Its clock.
    Clock,
}

struct Topic {
    subscription: Subscription,
    listeners: Vec<Listener>,
    /// When it wakes.
    rhythm: Rhythm,
}

/// All topics of a process. Tokens of the loop name them by their indices.
pub(crate) struct Topics {
    all: Vec<Topic>,
    /// What tells which networks of topics that wake nobody have brought something. Nobody sleeps on it.
    quiet: Poll,
    quiet_events: Events,
}

impl Topics {
    /// No topics yet.
    pub(crate) fn new() -> io::Result<Self> {
        Ok(Self { all: Vec::new(), quiet: Poll::new()?, quiet_events: Events::with_capacity(64) })
    }

    /// Has the network end of the topic that will be number `index` looked after without waking anybody.
    pub(crate) fn look_after(&mut self, index: usize, network: &mut dyn NetworkReader) -> Result<(), TransportError> {
        network
            .register(self.quiet.registry(), Token(index), Interest::READABLE)
            .map_err(|source| TransportError::System { what: "cannot look after a topic", source })
    }

    /// The index that the next topic will have.
    pub(crate) fn next(&self) -> usize {
        self.all.len()
    }

    /// Adds a topic that `listener` reads.
    pub(crate) fn add(&mut self, subscription: Subscription, listener: Listener) {
        self.all.push(Topic { subscription, listeners: vec![listener], rhythm: Rhythm::default() });
    }

    /// Lets `listener` read a topic that is open already, if it is; gives its reader.
    pub(crate) fn join(&mut self, topic: &str, subscribe: &Subscribe, listener: Listener) -> Option<&Subscription> {
        let open = self.all.iter_mut().find(|open| open.subscription.reads(topic, subscribe))?;
        open.listeners.push(listener);
        Some(&open.subscription)
    }

    /// The network has brought something on topic number `index`.
    pub(crate) fn network_wakes(&mut self, index: usize) {
        if let Some(topic) = self.all.get_mut(index) {
            topic.subscription.network_wakes();
        }
    }

    /// Brings what waits on topic number `index` to all who read it.
    pub(crate) fn take(&mut self, index: usize, now: Steady, nodes: &mut [Node]) {
        let Some(Topic { subscription, listeners, .. }) = self.all.get_mut(index) else { return };
        let mut problems = Vec::new();
        subscription.drain(
            now,
            |(source, arrived), cdr| {
                for listener in listeners.iter() {
                    let Some(node) = nodes.get_mut(listener.node) else { continue };
                    match listener.what {
                        Heard::Port(port) => node.handle(Event::Message { port, source, cdr, arrived: Some(arrived) }),
                        Heard::Clock => {
                            if let Ok(message) = ClockMessage::decode(cdr) {
                                node.set_clock(RosTime::from(&message.clock));
                            }
                        }
                    }
                }
            },
            |problem| problems.push(problem),
        );
        let lost = subscription.take_lost();
        if lost > 0 {
            self.warn(index, nodes, |topic| {
                format!("{topic}: {lost} message(s) lost: they came faster than this node reads")
            });
        }
        if let Some(first) = problems.first() {
            let count = problems.len();
            self.warn(index, nodes, |topic| {
                format!("{topic}: {count} unreadable message(s) dropped, the first because: {first}")
            });
        }
    }

    /// Topic number `index` has woken the process.
    pub(crate) fn beat(&mut self, index: usize, now: Steady) {
        if let Some(topic) = self.all.get_mut(index) {
            topic.rhythm.beat(now);
        }
    }

    /// When a topic will wake the process next, later than `earliest`, as far as that can be told.
    pub(crate) fn next_beat(&self, earliest: Steady) -> Option<Steady> {
        self.all.iter().filter_map(|topic| topic.rhythm.next()).filter(|next| *next > earliest).min()
    }

    /// Whether there are topics that wake nobody.
    pub(crate) fn some_wait(&self) -> bool {
        self.all.iter().any(|topic| !topic.subscription.wakes())
    }

    /// Brings what has come on topics that wake nobody: it is handed over before the next event that does.
    pub(crate) fn take_waiting(&mut self, now: Steady, nodes: &mut [Node]) -> io::Result<()> {
        if !self.some_wait() {
            return Ok(());
        }
        self.quiet.poll(&mut self.quiet_events, Some(Duration::ZERO))?;
        for event in &self.quiet_events {
            if let Some(topic) = self.all.get_mut(event.token().0) {
                topic.subscription.network_wakes();
            }
        }
        for index in 0..self.all.len() {
            if !self.all[index].subscription.wakes() {
                self.take(index, now, nodes);
            }
        }
        Ok(())
    }

    /// What time brings: shared memory that has appeared, with what is in there already, and messages that waited.
    pub(crate) fn tick(&mut self, now: Steady, host: &Host, registry: &Registry, nodes: &mut [Node]) {
        for index in 0..self.all.len() {
            let subscription = &mut self.all[index].subscription;
            match subscription.open_local(now, host, registry) {
                Ok(true) => {
                    self.debug(index, nodes, "through shared memory");
                    self.take(index, now, nodes);
                }
                Ok(false) if subscription.is_due(now) => self.take(index, now, nodes),
                Ok(false) => {}
                Err(problem) => self.warn(index, nodes, |_| format!("{problem}; the network is used instead")),
            }
        }
    }

    /// When [`Topics::tick`] is to be called next.
    pub(crate) fn next_tick(&self) -> Option<Steady> {
        self.all.iter().filter_map(|topic| topic.subscription.next_retry()).min()
    }

    /// Follows the ROS graph: matches, foreign types, and writers that may offer shared memory.
    pub(crate) fn graph_changed(&mut self, change: &GraphChange, nodes: &mut [Node]) {
        match change {
            GraphChange::Matched { reader, writers } => {
                let Some(index) = self.index_of(reader) else { return };
                self.debug(index, nodes, &format!("{writers} writer(s)"));
                self.tell(index, nodes, |port| Event::Matched { port, writers: *writers });
            }
            GraphChange::Presence { reader, writer, is_there } => {
                let Some(index) = self.index_of(reader) else { return };
                self.tell(index, nodes, |port| Event::Presence { port, gid: *writer, is_there: *is_there });
            }
            GraphChange::Writer { topic, type_name, .. } => self.look_at_writer(topic, type_name, nodes),
            GraphChange::Incompatible { reader, writer } => {
                if let Some(index) = self.index_of(reader) {
                    self.warn(index, nodes, |topic| {
                        format!("{topic}: the quality of service of writer {writer:02x?} does not suffice")
                    });
                }
            }
            GraphChange::Readers { .. } | GraphChange::Router { .. } => {}
        }
    }

    fn index_of(&self, reader: &Gid) -> Option<usize> {
        self.all.iter().position(|topic| topic.subscription.network.gid() == *reader)
    }

    /// Brings an event of a topic to all that read it, each with its own port.
    fn tell(&self, index: usize, nodes: &mut [Node], event: impl Fn(usize) -> Event<'static>) {
        for listener in &self.all[index].listeners {
            if let (Some(node), Heard::Port(port)) = (nodes.get_mut(listener.node), listener.what) {
                node.handle(event(port));
            }
        }
    }

    fn look_at_writer(&mut self, topic: &str, type_name: &str, nodes: &mut [Node]) {
        for index in 0..self.all.len() {
            let subscription = &mut self.all[index].subscription;
            if subscription.topic() != topic {
                continue;
            }
            subscription.look_for_writer();
            let own = subscription.type_name();
            if own != type_name {
                self.warn(index, nodes, |topic| {
                    format!(
                        "{topic}: another process writes {type_name} there; this node reads {own} and gets nothing of it"
                    )
                });
            }
        }
    }

    /// Says of a topic that somebody writes it for nothing, in the name of the first node that reads it.
    fn warn(&self, index: usize, nodes: &mut [Node], text: impl FnOnce(&str) -> String) {
        if let Some(node) = self.all[index].listeners.first().and_then(|first| nodes.get_mut(first.node)) {
            node.topic_unread(text(self.all[index].subscription.topic()));
        }
    }

    fn debug(&self, index: usize, nodes: &mut [Node], text: &str) {
        if let Some(node) = self.all[index].listeners.first().and_then(|first| nodes.get_mut(first.node)) {
            node.debug(&format!("{}: {text}", self.all[index].subscription.topic()));
        }
    }
}

impl Connections<'_> {
    /// Has node number `index`, called `node` in full, read `topic`, an absolute name. With `shared` it gets what other
    /// nodes of the process get already; without, it is a reader of its own, which the past of a latched topic comes to.
    pub(crate) fn subscribe(
        &mut self,
        node: &str,
        listener: Listener,
        topic: String,
        subscribe: &Subscribe,
        shared: bool,
    ) -> Result<(), TransportError> {
        if shared && let Some(open) = self.topics.join(&topic, subscribe, listener) {
            self.network.share_reader(node, open.network.gid());
            return Ok(());
        }
        let subscription = self.open(node, topic, subscribe)?;
        self.topics.add(subscription, listener);
        Ok(())
    }
}
