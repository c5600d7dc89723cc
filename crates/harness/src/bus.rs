//! The graph of one lock-step run: who reads what, and what is on its way.

use std::collections::{BTreeMap, VecDeque};
use std::rc::Rc;
use trench_core::arguments::{NameKind, Names};
use trench_core::{ByteStream, RequestId, Source};

/// One end of something: the instance and the index into the list of its interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct End {
    pub(crate) instance: usize,
    pub(crate) index: usize,
}

/// Something on its way to a core.
#[derive(Debug, Clone)]
pub(crate) enum Delivery {
    Message { to: End, source: Source, cdr: Rc<[u8]> },
    Request { to: End, id: RequestId, cdr: Rc<[u8]> },
    Response { to: End, cdr: Option<Rc<[u8]>> },
    Bytes { to: End, data: Rc<[u8]> },
    StreamState { to: End, open: bool },
    Matched { to: End, writers: usize },
}

#[derive(Debug, Default)]
struct Topic {
    type_name: &'static str,
    readers: Vec<End>,
    writers: Vec<End>,
}

/// Topics, services and byte streams by absolute name, and the deliveries due now, in order.
#[derive(Debug, Default)]
pub(crate) struct Bus {
    topics: Vec<Topic>,
    topic_names: BTreeMap<String, usize>,
    servers: BTreeMap<String, End>,
    callers: BTreeMap<RequestId, End>,
    masters: BTreeMap<String, End>,
    lines: BTreeMap<End, End>,
    requests: u64,
    pub(crate) due: VecDeque<Delivery>,
}

/// What a reader and a writer of one topic disagree on.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum BusError {
    /// Two types under one topic name.
    #[error("{topic} is {first} for one node and {second} for another")]
    Type {
        /// The topic.
        topic: String,
        /// One type.
        first: &'static str,
        /// The other.
        second: &'static str,
    },
}

impl Bus {
    /// Puts all ends of an interface on the bus; gives the number of each publication's topic.
    pub(crate) fn join(
        &mut self,
        instance: usize,
        names: &Names<'_>,
        interface: &trench_core::Interface,
    ) -> Result<Vec<usize>, BusError> {
        let end = |index| End { instance, index };
        for (index, subscribe) in interface.subscriptions.iter().enumerate() {
            let topic = self.topic(names.resolve(&subscribe.topic, NameKind::Topic), subscribe.type_info.name)?;
            self.topics[topic].readers.push(end(index));
        }
        let mut written = Vec::new();
        for (index, advertise) in interface.publications.iter().enumerate() {
            let topic = self.topic(names.resolve(&advertise.topic, NameKind::Topic), advertise.type_info.name)?;
            self.topics[topic].writers.push(end(index));
            written.push(topic);
        }
        for (index, serve) in interface.services.iter().enumerate() {
            self.servers.insert(names.resolve(&serve.name, NameKind::Service), end(index));
        }
        for (index, stream) in interface.byte_streams.iter().enumerate() {
            if let ByteStream::PseudoTerminal { link } = stream {
                self.masters.insert(link.clone(), end(index));
            }
        }
        Ok(written)
    }

    fn topic(&mut self, name: String, type_name: &'static str) -> Result<usize, BusError> {
        if let Some(&number) = self.topic_names.get(&name) {
            let first = self.topics[number].type_name;
            if first != type_name {
                return Err(BusError::Type { topic: name, first, second: type_name });
            }
            return Ok(number);
        }
        self.topics.push(Topic { type_name, ..Topic::default() });
        self.topic_names.insert(name, self.topics.len() - 1);
        Ok(self.topics.len() - 1)
    }

    /// Connects a serial port to the pseudo-terminal of the same path. Gives whether there is one.
    pub(crate) fn plug(&mut self, serial: End, path: &str) -> bool {
        let Some(&master) = self.masters.get(path) else { return false };
        self.lines.insert(serial, master);
        self.lines.insert(master, serial);
        for to in [master, serial] {
            self.due.push_back(Delivery::StreamState { to, open: true });
        }
        true
    }

    /// Tells every reader how many writers it has.
    pub(crate) fn announce(&mut self) {
        for topic in self.topic_names.values().map(|number| &self.topics[*number]) {
            for &to in topic.readers.iter().filter(|_| !topic.writers.is_empty()) {
                self.due.push_back(Delivery::Matched { to, writers: topic.writers.len() });
            }
        }
    }

    /// Sends a message to all readers of the topic of this number.
    pub(crate) fn publish(&mut self, topic: usize, source: Source, message: &[u8]) {
        let readers = &self.topics[topic].readers;
        if readers.is_empty() {
            return;
        }
        let cdr: Rc<[u8]> = message.into();
        self.due.extend(readers.iter().map(|&to| Delivery::Message { to, source, cdr: Rc::clone(&cdr) }));
    }

    /// Sends a request to the server of `service`; without one the answer is nothing.
    pub(crate) fn call(&mut self, from: End, service: &str, cdr: Rc<[u8]>) {
        match self.servers.get(service) {
            Some(&to) => {
                self.requests += 1;
                let id = RequestId(self.requests);
                self.callers.insert(id, from);
                self.due.push_back(Delivery::Request { to, id, cdr });
            }
            None => self.due.push_back(Delivery::Response { to: from, cdr: None }),
        }
    }

    /// Sends an answer back to whoever asked.
    pub(crate) fn respond(&mut self, id: RequestId, cdr: Rc<[u8]>) {
        if let Some(to) = self.callers.remove(&id) {
            self.due.push_back(Delivery::Response { to, cdr: Some(cdr) });
        }
    }

    /// Sends bytes to the other end of the line; to an open end they are lost.
    pub(crate) fn write(&mut self, from: End, bytes: Rc<[u8]>) {
        if let Some(&to) = self.lines.get(&from) {
            self.due.push_back(Delivery::Bytes { to, data: bytes });
        }
    }
}

/// A GID that is the same in every run: which instance, which publication.
pub(crate) fn gid(end: End) -> [u8; 16] {
    let mut gid = [0; 16];
    gid[..4].copy_from_slice(b"sim\0");
    gid[4..8].copy_from_slice(&(end.instance as u32).to_be_bytes());
    gid[8..12].copy_from_slice(&(end.index as u32).to_be_bytes());
    gid
}
