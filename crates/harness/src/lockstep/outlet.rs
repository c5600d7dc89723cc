//! The way out of a core in lock-step: everything goes on the bus at once, in the order of the calls.

use crate::Observer;
use crate::bus::{Bus, End, gid};
use trench_core::arguments::{NameKind, Names};
use trench_core::{Advertise, Interface, Level, RequestId, Sink, Source, Times};
use trench_msgs::Encode;

/// Where a core's publications, calls and log lines lead.
pub(crate) struct Outlets {
    instance: usize,
    /// The node's full name.
    pub(crate) label: String,
    publications: Vec<Publication>,
    clients: Vec<String>,
}

struct Publication {
    topic: String,
    number: usize,
    advertise: Advertise,
    /// Of the last message.
    source: Source,
}

impl Outlets {
    /// `topics` are the numbers of the publications' topics.
    pub(crate) fn new(instance: usize, names: &Names<'_>, interface: &Interface, topics: Vec<usize>) -> Self {
        let publication = |(index, (advertise, number)): (usize, (&Advertise, usize))| Publication {
            topic: names.resolve(&advertise.topic, NameKind::Topic),
            number,
            advertise: advertise.clone(),
            source: Source { gid: gid(End { instance, index }), sequence: 0 },
        };
        let service = |name: &str| names.resolve(name, NameKind::Service);
        Self {
            instance,
            label: names.resolve("~", NameKind::Topic),
            publications: interface.publications.iter().zip(topics).enumerate().map(publication).collect(),
            clients: interface.clients.iter().map(|serve| service(&serve.name)).collect(),
        }
    }
}

/// Takes what a core wants done at one event.
pub(crate) struct Outlet<'a> {
    pub(crate) outlets: &'a mut Outlets,
    pub(crate) at: Times,
    pub(crate) bus: &'a mut Bus,
    pub(crate) scratch: &'a mut Vec<u8>,
    pub(crate) observer: &'a mut dyn Observer,
    /// The code with which the core wants to end.
    pub(crate) exit: Option<u8>,
}

impl Outlet<'_> {
    fn end(&self, index: usize) -> End {
        End { instance: self.outlets.instance, index }
    }
}

impl Sink for Outlet<'_> {
    fn publish_with(&mut self, port: usize, max_len: usize, fill: &mut dyn FnMut(&mut [u8]) -> usize) {
        if self.scratch.len() < max_len {
            self.scratch.resize(max_len, 0);
        }
        let length = fill(&mut self.scratch[..max_len]);
        let message = &self.scratch[..length];
        let publication = &mut self.outlets.publications[port];
        publication.source.sequence += 1;
        let Publication { topic, number, advertise, source } = publication;
        self.bus.publish(*number, *source, message);
        self.observer.published(self.at, topic, advertise, *source, message);
    }

    fn respond(&mut self, _: usize, id: RequestId, response: &dyn Encode) {
        self.bus.respond(id, response.to_cdr().into());
    }

    fn call(&mut self, client: usize, request: &dyn Encode) {
        self.bus.call(self.end(client), &self.outlets.clients[client], request.to_cdr().into());
    }

    fn write_bytes(&mut self, stream: usize, bytes: &[u8]) {
        self.bus.write(self.end(stream), bytes.into());
    }

    fn log(&mut self, level: Level, text: &str) {
        self.observer.logged(self.at, &self.outlets.label, level, text);
    }

    /// Nothing outlives a lock-step run.
    fn checkpoint(&mut self, _: &[u8]) {}

    fn exit(&mut self, code: u8) {
        self.exit = Some(code);
    }
}
