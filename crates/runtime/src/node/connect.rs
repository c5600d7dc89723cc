//! Opening all that a core's interface names.

use super::{Caller, Node, Ports, Publication, Subscription, Wake};
use crate::arguments::{NameKind, Names};
use crate::checkpoint::Checkpoint;
use crate::clock::Clock;
use crate::log::Logger;
use crate::stream::Stream;
use crate::transport::TransportError;
use crate::transport::dds::{Participant, TopicName, full_name};
use rustdds::mio1::{Interest, Registry, Token, event};
use std::collections::BTreeMap;
use trench_core::{NodeCore, Qos, Subscribe};
use trench_msgs::Message;
use trench_msgs::rcl_interfaces::Log;
use trench_msgs::rosgraph_msgs::Clock as ClockMessage;

/// What nodes are connected to, and what wakes the loop for them.
pub(crate) struct Connections<'a> {
    pub(crate) participant: &'a mut Participant,
    pub(crate) registry: &'a Registry,
    /// What each token of the loop means: the node's index and what arrived there.
    pub(crate) wakes: &'a mut Vec<Option<(usize, Wake)>>,
}

impl Connections<'_> {
    fn token(&mut self, node: usize, wake: Wake) -> Token {
        self.wakes.push(Some((node, wake)));
        Token(self.wakes.len() - 1)
    }

    fn register(&mut self, node: usize, wake: Wake, source: &mut dyn event::Source) -> Result<(), TransportError> {
        let token = self.token(node, wake);
        source
            .register(self.registry, token, Interest::READABLE)
            .map_err(|source| TransportError::System { what: "cannot wait for a topic", source })
    }
}

/// What a node needs besides its connections.
pub(crate) struct Equipment {
    pub(crate) clock: Clock,
    pub(crate) logger: Logger,
    pub(crate) rosout: bool,
    pub(crate) checkpoint: Checkpoint,
}

/// Connects `core`, the node number `index` of the process.
pub(crate) fn connect(
    core: Box<dyn NodeCore>,
    index: usize,
    names: &Names<'_>,
    mut equipment: Equipment,
    to: &mut Connections<'_>,
) -> Result<Node, TransportError> {
    let node = full_name(&names.namespace, &names.node);
    to.participant.add_node(&names.namespace, &names.node)?;
    if equipment.rosout {
        let name = TopicName::message("/rosout", Log::TYPE.name);
        equipment.logger.attach(to.participant.writer(&node, &name, ROSOUT)?);
    }
    let interface = core.interface().clone();
    let clock = match equipment.clock {
        Clock::System => None,
        Clock::Simulated(_) => {
            let subscribe = Subscribe { topic: "/clock".to_owned(), type_info: ClockMessage::TYPE, qos: Qos::SENSOR };
            Some(subscription(&node, index, names, &subscribe, Wake::Clock, to)?)
        }
    };
    let mut subscriptions = Vec::new();
    for (port, subscribe) in interface.subscriptions.iter().enumerate() {
        subscriptions.push(subscription(&node, index, names, subscribe, Wake::Messages(port), to)?);
    }
    let mut publications = Vec::new();
    for advertise in &interface.publications {
        let topic = names.resolve(&advertise.topic, NameKind::Topic);
        let name = TopicName::message(&topic, advertise.type_info.name);
        let network = to.participant.writer(&node, &name, advertise.qos)?;
        publications.push(Publication::new(topic, network, advertise));
    }
    let mut servers = Vec::new();
    for (service, serve) in interface.services.iter().enumerate() {
        let name = names.resolve(&serve.name, NameKind::Service);
        let mut server = to.participant.server(&node, &name, serve.service.name)?;
        to.register(index, Wake::Requests(service), &mut server.requests)?;
        servers.push(server);
    }
    let mut callers = Vec::new();
    for (client, call) in interface.clients.iter().enumerate() {
        let name = names.resolve(&call.name, NameKind::Service);
        let mut service = to.participant.client(&node, &name, call.service.name)?;
        to.register(index, Wake::Responses(client), &mut service.responses)?;
        callers.push(Caller::new(service));
    }
    let streams = interface.byte_streams.iter().enumerate();
    let streams = streams.map(|(number, stream)| Stream::new(stream, to.token(index, Wake::Stream(number)))).collect();
    let registry = to
        .registry
        .try_clone()
        .map_err(|source| TransportError::System { what: "cannot share the event loop", source })?;
    let ports = Ports {
        clock: equipment.clock,
        logger: equipment.logger,
        publications,
        servers,
        callers,
        streams,
        checkpoint: equipment.checkpoint,
        registry,
        pending: BTreeMap::new(),
        next_request: 0,
        broken: Vec::new(),
        exit: None,
    };
    Ok(Node { core, subscriptions, clock, ports })
}

/// Late joiners get the last lines; as many as rclcpp keeps.
const ROSOUT: Qos = Qos { depth: 1000, ..Qos::LATCHED };

fn subscription(
    node: &str,
    index: usize,
    names: &Names<'_>,
    subscribe: &Subscribe,
    wake: Wake,
    to: &mut Connections<'_>,
) -> Result<Subscription, TransportError> {
    let topic = names.resolve(&subscribe.topic, NameKind::Topic);
    let name = TopicName::message(&topic, subscribe.type_info.name);
    let mut network = to.participant.reader(node, &name, subscribe.qos)?;
    to.register(index, wake, &mut network)?;
    Ok(Subscription::new(topic, name, network, subscribe))
}
