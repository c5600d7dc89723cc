//! Following the ROS graph: matches, foreign types, and shared memory that appears.

use super::connect::subscription;
use super::{Connections, Node, Subscription, Wake};
use crate::transport::TransportError;
use crate::transport::dds::GraphChange;
use crate::transport::shared_memory::Host;
use trench_core::{Discovered, Event, Level, Sink, Steady};

impl Node {
    /// Follows the ROS graph.
    pub(crate) fn graph_changed(&mut self, change: &GraphChange) {
        match change {
            GraphChange::Matched { reader, writers } => {
                self.ports.callers.iter_mut().for_each(|caller| caller.service.writers_changed(*reader, *writers));
                let port = self.subscriptions.iter().position(|subscription| subscription.network.guid() == *reader);
                if let Some(port) = port {
                    self.handle(Event::Matched { port, writers: *writers });
                }
            }
            GraphChange::Readers { writer, readers } => {
                self.ports.callers.iter_mut().for_each(|caller| caller.service.readers_changed(*writer, readers));
                let servers = self.ports.servers.iter_mut().chain(self.parameters.services());
                servers.for_each(|server| server.readers_changed(*writer, readers));
                self.ports.publications.iter_mut().for_each(|topic| topic.readers_changed(*writer, readers));
            }
            GraphChange::Writer { topic, type_name, .. } => self.look_at_writer(topic, type_name),
            GraphChange::Incompatible { local, remote } => {
                let reader = self.subscriptions.iter().find(|subscription| subscription.network.guid() == *local);
                if let Some(topic) = reader.map(|reader| reader.topic().to_owned()) {
                    let text = format!("{topic}: the quality of service of writer {remote:?} does not suffice");
                    self.ports.warn(&text);
                }
            }
        }
    }

    /// Opens the subscription that the core wants to a topic that was discovered, as node number `index` of the
    /// process. Whether it wanted one.
    pub(crate) fn discover(
        &mut self,
        topic: Discovered<'_>,
        index: usize,
        to: &mut Connections<'_>,
    ) -> Result<bool, TransportError> {
        let Some(subscribe) = self.core.discovered(topic) else { return Ok(false) };
        let wake = Wake::Messages(self.subscriptions.len());
        self.subscriptions.push(subscription(&self.full_name, index, subscribe.topic.clone(), &subscribe, wake, to)?);
        Ok(true)
    }

    pub(super) fn readers(&self) -> impl Iterator<Item = &Subscription> {
        self.subscriptions.iter().chain(&self.clock)
    }

    /// Opens shared memory where it has appeared; what is in there already is delivered at once.
    pub(super) fn open_shared_memory(&mut self, now: Steady, host: &Host) {
        for port in 0..self.subscriptions.len() {
            match self.subscriptions[port].open_local(now, host, &self.ports.registry) {
                Ok(true) => {
                    let text = format!("{}: through shared memory", self.subscriptions[port].topic());
                    self.ports.log(Level::Debug, &text);
                    self.take_messages(port);
                }
                Ok(false) if self.subscriptions[port].is_due(now) => self.take_messages(port),
                Ok(false) => {}
                Err(problem) => self.ports.warn(&format!("{problem}; the network is used instead")),
            }
        }
        match self.clock.as_mut().map(|clock| clock.open_local(now, host, &self.ports.registry)) {
            Some(Ok(true)) => self.take_clock(),
            Some(Err(problem)) => self.ports.warn(&format!("{problem}; the network is used instead")),
            Some(Ok(false)) | None => {}
        }
    }

    fn look_at_writer(&mut self, topic: &str, type_name: &str) {
        let readers = self.subscriptions.iter_mut().chain(&mut self.clock);
        readers.filter(|reader| reader.network_name().topic() == topic).for_each(Subscription::look_for_writer);
        let foreign = self.subscriptions.iter().find(|subscription| {
            subscription.network_name().topic() == topic && subscription.network_name().type_name() != type_name
        });
        if let Some(subscription) = foreign {
            let text = format!(
                "{}: another process writes {type_name} there; this node reads {} and gets nothing of it",
                subscription.topic(),
                subscription.network_name().type_name()
            );
            self.ports.warn(&text);
        }
    }
}
