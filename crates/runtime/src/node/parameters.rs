//! A node's parameters on the network.

use super::connect::Connections;
use super::{Node, NodeWake, Wake};
use crate::parameters::{ParameterServer, ParameterService};
use crate::transport::TransportError;
use crate::transport::network::{NetworkWriter, PendingRequest, ServiceServer, TopicName};
use rustdds::bytes::Bytes;
use trench_core::{Durability, Level, Qos, Reliability, Sink};
use trench_msgs::rcl_interfaces::ParameterEvent;
use trench_msgs::{Encode, Message};

/// As every ROS 2 node offers it.
const EVENTS: Qos = Qos { reliability: Reliability::Reliable, durability: Durability::Volatile, depth: 1000 };

/// The services and the topic of changes.
pub(super) struct NodeParameters {
    server: ParameterServer,
    /// In the order of [`ParameterService::ALL`].
    services: Vec<Box<dyn ServiceServer>>,
    events: Box<dyn NetworkWriter>,
}

impl NodeParameters {
    pub(super) fn open(
        server: ParameterServer,
        node: &str,
        index: usize,
        to: &mut Connections<'_>,
    ) -> Result<Self, TransportError> {
        let mut services = Vec::new();
        for (number, service) in ParameterService::ALL.into_iter().enumerate() {
            let name = format!("{node}/{}", service.name());
            let mut opened = to.network.server(node, &name, service.info())?;
            to.register(Wake::Node(index, NodeWake::Parameters(number)), opened.as_mut())?;
            services.push(opened);
        }
        let name = TopicName::new("/parameter_events", ParameterEvent::TYPE);
        let events = to.network.writer(node, &name, EVENTS)?;
        Ok(Self { server, services, events })
    }

    pub(super) fn services(&mut self) -> &mut [Box<dyn ServiceServer>] {
        &mut self.services
    }

    /// Sends what waits; true when nothing waits any longer.
    pub(super) fn flush(&mut self) -> bool {
        let mut done = self.events.flush();
        for service in &mut self.services {
            done &= service.flush();
        }
        done
    }

    fn tell(&mut self, event: &ParameterEvent) {
        let _congested = self.events.write(event.to_cdr().into());
    }
}

impl Node {
    /// Tells of all parameters, once at the start.
    pub(super) fn tell_parameters(&mut self) {
        let birth = self.parameters.server.birth(self.ports.clock.now().ros);
        self.parameters.tell(&birth);
    }

    pub(super) fn take_parameter_requests(&mut self, number: usize) {
        self.parameters.services[number].clear_wakeup();
        while let Some(taken) = self.parameters.services[number].take() {
            match taken {
                Ok((request, cdr)) => self.answer_parameters(number, request, &cdr),
                Err(problem) => self.ports.warn(&problem),
            }
        }
    }

    fn answer_parameters(&mut self, number: usize, request: PendingRequest, cdr: &Bytes) {
        let service = ParameterService::ALL[number];
        let (core, at) = (&mut self.core, self.ports.clock.now().ros);
        match self.parameters.server.answer(service, cdr, at, &mut |values| core.set_parameters(values)) {
            Ok(reply) => {
                if let Err(reason) = self.parameters.services[number].respond(request, reply.response.into()) {
                    self.ports.warn(&format!("{}: a response was not sent: {reason}", service.name()));
                }
                if let Some(event) = reply.event {
                    let names: Vec<_> = event.changed_parameters.iter().map(|one| one.name.as_str()).collect();
                    self.ports.log(Level::Info, &format!("parameters changed: {}", names.join(", ")));
                    self.parameters.tell(&event);
                }
            }
            Err(error) => self.ports.warn(&format!("{}: request dropped: {error}", service.name())),
        }
    }
}
