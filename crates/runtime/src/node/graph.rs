//! Following the ROS graph: who answers, who reads, and topics that a core wants to read once somebody writes them.

use super::{Connections, Node};
use crate::topics::{Heard, Listener};
use crate::transport::TransportError;
use crate::transport::network::GraphChange;
use trench_core::{Discovered, Subscribe};

impl Node {
    /// Follows the ROS graph, as far as it is not about topics that are read.
    pub(crate) fn graph_changed(&mut self, change: &GraphChange) {
        match change {
            GraphChange::Matched { reader, writers } => {
                self.ports.callers.iter_mut().for_each(|caller| caller.service.writers_changed(reader, *writers));
                if let Some(clock) = &mut self.reference {
                    clock.writers_changed(reader, *writers);
                }
            }
            GraphChange::Readers { writer, readers } => {
                self.ports.callers.iter_mut().for_each(|caller| caller.service.readers_changed(writer, readers));
                let servers = self.ports.servers.iter_mut().chain(self.parameters.services());
                let servers = servers.chain(&mut self.time_server);
                servers.for_each(|server| server.readers_changed(writer, readers));
                if let Some(clock) = &mut self.reference {
                    clock.readers_changed(writer, readers);
                }
                self.ports.publications.iter_mut().for_each(|topic| topic.readers_changed(writer, readers));
            }
            GraphChange::Router { at, is_there } => self.router_changed(at, *is_there),
            GraphChange::Presence { .. } | GraphChange::Writer { .. } | GraphChange::Incompatible { .. } => {}
        }
    }

    /// The subscription that the core wants to a topic that was discovered.
    pub(crate) fn wants(&mut self, topic: Discovered<'_>) -> Option<Subscribe> {
        self.core.discovered(topic)
    }

    /// Opens such a subscription, as node number `index` of the process.
    pub(crate) fn open_found(
        &mut self,
        subscribe: &Subscribe,
        index: usize,
        to: &mut Connections<'_>,
    ) -> Result<(), TransportError> {
        let listener = Listener { node: index, what: Heard::Port(self.subscribed) };
        to.subscribe(&self.full_name, listener, subscribe.topic.clone(), subscribe, false)?;
        self.subscribed += 1;
        Ok(())
    }
}
