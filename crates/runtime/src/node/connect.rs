//! Opening all that a core's interface names.

use super::notices::Notices;
use super::parameters::NodeParameters;
use super::reference::{self, ClockReference};
use super::subscription::Reading;
use super::{Caller, Node, NodeWake, Ports, Publication, Subscription, Wake};
use crate::checkpoint::Checkpoint;
use crate::clock::Clock;
use crate::log::Logger;
use crate::parameters::ParameterServer;
use crate::stream::Stream;
use crate::topics::{Heard, Listener, Topics};
use crate::transport::network::{Network, TopicName};
use crate::transport::shared_memory::{Host, SharedWriter};
use crate::transport::{TransportError, full_name};
use rustdds::mio1::{Interest, Registry, Token, event};
use std::collections::BTreeMap;
use trench_core::arguments::{NameKind, Names};
use trench_core::{Advertise, Durability, Level, Local, NodeCore, Qos, Reliability, Subscribe};
use trench_msgs::Message;
use trench_msgs::rcl_interfaces::Log;
use trench_msgs::rosgraph_msgs::Clock as ClockMessage;

/// What nodes are connected to, and what wakes the loop for them.
pub(crate) struct Connections<'a> {
    pub(crate) network: &'a mut dyn Network,
    pub(crate) host: &'a Host,
    pub(crate) registry: &'a Registry,
    /// What the process reads.
    pub(crate) topics: &'a mut Topics,
    /// What each token of the loop means.
    pub(crate) wakes: &'a mut Vec<Option<Wake>>,
}

impl Connections<'_> {
    fn token(&mut self, wake: Wake) -> Token {
        self.wakes.push(Some(wake));
        Token(self.wakes.len() - 1)
    }

    pub(super) fn register(&mut self, wake: Wake, source: &mut dyn event::Source) -> Result<(), TransportError> {
        let token = self.token(wake);
        source
            .register(self.registry, token, Interest::READABLE)
            .map_err(|source| TransportError::System { what: "cannot wait for a topic", source })
    }

    /// Opens both ends of a subscription to `topic`, an absolute name, as the next topic of the process.
    pub(crate) fn open(
        &mut self,
        node: &str,
        topic: String,
        subscribe: &Subscribe,
    ) -> Result<Subscription, TransportError> {
        let shared_name = self.host.topic(&topic, subscribe.type_info.name);
        let name = TopicName::new(topic, subscribe.type_info);
        let mut network = self.network.reader(node, &name, subscribe.qos)?;
        let index = self.topics.next();
        let mut local_token = None;
        if subscribe.wakes {
            self.register(Wake::Network(index), network.as_mut())?;
            local_token = Some(self.token(Wake::Topic(index)));
        } else {
            self.topics.look_after(index, network.as_mut())?;
        }
        Ok(Subscription::new(Reading { name, shared_name, qos: subscribe.qos }, network, local_token))
    }
}

/// What a node needs besides its connections.
pub(crate) struct Equipment {
    pub(crate) clock: Clock,
    pub(crate) logger: Logger,
    pub(crate) rosout: bool,
    pub(crate) checkpoint: Checkpoint,
    /// Topics that also go over the network although they are meant for this host; `*` means all.
    pub(crate) publish_over_network: Vec<String>,
    /// Topics of which the node takes what comes; `*` means all that are not latched.
    pub(crate) read_best_effort: Vec<String>,
    /// bit/s, that images of each topic may take of the network.
    pub(crate) network_rate: f64,
    /// The node whose clock is ROS time, if it is not this host's.
    pub(crate) clock_reference: Option<String>,
    /// Whether the node tells its time to others.
    pub(crate) serve_clock: bool,
    pub(crate) parameters: ParameterServer,
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
    to.network.add_node(&names.namespace, &names.node)?;
    if equipment.rosout {
        let name = TopicName::new("/rosout", Log::TYPE);
        equipment.logger.attach(to.network.writer(&node, &name, ROSOUT)?);
    }
    let reference = match &equipment.clock_reference {
        Some(of) => Some(ClockReference::open(of, &node, index, to)?),
        None => None,
    };
    let time_server = if equipment.serve_clock { Some(reference::server(&node, index, to)?) } else { None };
    let interface = core.interface().clone();
    if matches!(equipment.clock, Clock::Simulated(_)) {
        let subscribe = Subscribe::to::<ClockMessage>("/clock", Qos::SENSOR);
        let topic = names.resolve(&subscribe.topic, NameKind::Topic);
        to.subscribe(&node, Listener { node: index, what: Heard::Clock }, topic, &subscribe, true)?;
    }
    for (port, subscribe) in interface.subscriptions.iter().enumerate() {
        let topic = names.resolve(&subscribe.topic, NameKind::Topic);
        let qos = asked_for(subscribe, is_named(&equipment.read_best_effort, &topic));
        let subscribe = Subscribe { qos, ..subscribe.clone() };
        to.subscribe(&node, Listener { node: index, what: Heard::Port(port) }, topic, &subscribe, true)?;
    }
    let mut publications = Vec::new();
    for advertise in &interface.publications {
        publications.push(publication(&node, names, advertise, &mut equipment, to)?);
    }
    let mut servers = Vec::new();
    for (service, serve) in interface.services.iter().enumerate() {
        let name = names.resolve(&serve.name, NameKind::Service);
        let mut server = to.network.server(&node, &name, serve.service)?;
        to.register(Wake::Node(index, NodeWake::Requests(service)), server.as_mut())?;
        servers.push(server);
    }
    let mut callers = Vec::new();
    for (client, call) in interface.clients.iter().enumerate() {
        let name = names.resolve(&call.name, NameKind::Service);
        let mut service = to.network.client(&node, &name, call.service)?;
        to.register(Wake::Node(index, NodeWake::Responses(client)), service.as_mut())?;
        callers.push(Caller::new(service));
    }
    let streams = interface.byte_streams.iter().enumerate();
    let mut token = |number| to.token(Wake::Node(index, NodeWake::Stream(number)));
    let streams = streams.map(|(number, stream)| Stream::new(stream, token(number))).collect();
    let registry = to
        .registry
        .try_clone()
        .map_err(|source| TransportError::System { what: "cannot share the event loop", source })?;
    let parameters = NodeParameters::open(equipment.parameters, &node, index, to)?;
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
    let subscribed = interface.subscriptions.len();
    let notices = Notices::default();
    Ok(Node { full_name: node, subscribed, core, reference, time_server, parameters, notices, ports })
}

/// Whether a list of topics has this one.
fn is_named(topics: &[String], topic: &str) -> bool {
    topics.iter().any(|name| name == "*" || name == topic)
}

/// What a node asks for that is told to take what comes: not the past of latched topics, nor what comes once.
fn asked_for(subscribe: &Subscribe, takes_what_comes: bool) -> Qos {
    let qos = subscribe.qos;
    if takes_what_comes && subscribe.comes_again && qos.durability == Durability::Volatile {
        Qos { reliability: Reliability::BestEffort, ..qos }
    } else {
        qos
    }
}

/// Late joiners get the last lines; as many as rclcpp keeps.
const ROSOUT: Qos = Qos { depth: 1000, ..Qos::LATCHED };

fn publication(
    node: &str,
    names: &Names<'_>,
    advertise: &Advertise,
    equipment: &mut Equipment,
    to: &mut Connections<'_>,
) -> Result<Publication, TransportError> {
    let topic = names.resolve(&advertise.topic, NameKind::Topic);
    let type_name = advertise.type_info.name;
    // Shared memory first: readers look for it as soon as they hear of the topic's network end.
    let mut shared = |max_len| shared_writer(&topic, type_name, max_len, advertise.qos, equipment, to);
    let (local, max_len, to_network) = match advertise.local {
        Local::NetworkOnly => (None, 0, true),
        Local::SharedMemory { max_len } => (shared(max_len), max_len, true),
        Local::SharedMemoryOnly { max_len } => {
            let local = shared(max_len);
            let wanted = is_named(&equipment.publish_over_network, &topic);
            // Where there is no shared memory, a slow image is better than none.
            let to_network = wanted || local.is_none();
            (local, max_len, to_network)
        }
    };
    let name = TopicName::new(topic.as_str(), advertise.type_info);
    let mut publication = Publication::new(topic, advertise.qos, to.network.writer(node, &name, advertise.qos)?);
    publication.limit(equipment.network_rate);
    if let Some(local) = local {
        publication.share(local, max_len, to_network);
    }
    Ok(publication)
}

/// Opens shared memory if it can be had: without it, the network carries everything.
fn shared_writer(
    topic: &str,
    type_name: &str,
    max_len: usize,
    qos: Qos,
    equipment: &mut Equipment,
    to: &Connections<'_>,
) -> Option<SharedWriter> {
    let writer = to.host.writer(&to.host.topic(topic, type_name), max_len, qos);
    writer
        .map_err(|error| {
            let text = format!("{error}; readers of this host get it over the network");
            equipment.logger.log(equipment.clock.now().ros, Level::Warn, &text);
        })
        .ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_comes_again_may_be_lost() {
        let named =
            |topics: &[&str], topic| is_named(&topics.iter().map(ToString::to_string).collect::<Vec<_>>(), topic);
        assert!(named(&["*"], "/goals") && named(&["/goals"], "/goals"));
        assert!(!named(&["/goals"], "/goal") && !named(&[], "/goals"));
        let taken = Qos { reliability: Reliability::BestEffort, ..Qos::RELIABLE };
        let check = |subscribe: Subscribe, takes, expected| assert_eq!(asked_for(&subscribe, takes), expected);
        let of = |qos| Subscribe::to::<Log>("/topic", qos);
        check(of(Qos::RELIABLE), true, taken);
        check(of(Qos::RELIABLE), false, Qos::RELIABLE);
        check(of(Qos::RELIABLE).once(), true, Qos::RELIABLE);
        check(of(Qos::LATCHED), true, Qos::LATCHED);
    }
}
