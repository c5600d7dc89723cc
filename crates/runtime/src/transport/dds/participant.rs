//! A process's place on the network: one DDS participant for all its nodes.

use super::graph::{Endpoint, Graph};
use super::raw::{RawAdapter, RawMessage};
use super::status::StatusReader;
use super::{NetworkReader, NetworkWriter, ServiceClient, ServiceServer, TransportError, qos};
use rustdds::no_key::{DataWriter, SimpleDataReader};
use rustdds::{
    DomainParticipant, DomainParticipantBuilder, GUID, Publisher, QosPolicies, QosPolicyBuilder, Subscriber, Topic,
};
use rustdds::{RTPSEntity, TopicKind};
use trench_core::Qos;

/// A topic as DDS names it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct TopicName {
    topic: String,
    type_name: String,
}

impl TopicName {
    /// `/team_state` of type `trench_msgs/msg/TeamState`.
    pub(crate) fn message(topic: &str, type_name: &str) -> Self {
        Self { topic: format!("rt{topic}"), type_name: dds_type(type_name, "") }
    }

    /// The requests of service `/node/arm` of type `std_srvs/srv/Trigger`.
    pub(crate) fn request(service: &str, type_name: &str) -> Self {
        Self { topic: format!("rq{service}Request"), type_name: dds_type(type_name, "_Request") }
    }

    /// The responses of the same service.
    pub(crate) fn response(service: &str, type_name: &str) -> Self {
        Self { topic: format!("rr{service}Reply"), type_name: dds_type(type_name, "_Response") }
    }

    /// Topic and type as ROS names them; nothing for what is no topic of ROS (services, DDS's own).
    pub(crate) fn ros_message(topic: &str, type_name: &str) -> Option<(String, String)> {
        let topic = topic.strip_prefix("rt").filter(|topic| topic.starts_with('/'))?;
        let (package, name) = type_name.split_once("::msg::dds_::")?;
        Some((topic.to_owned(), format!("{package}/msg/{}", name.strip_suffix('_')?)))
    }

    /// The topic, `rt/team_state`.
    pub(crate) fn topic(&self) -> &str {
        &self.topic
    }

    /// The type, `trench_msgs::msg::dds_::TeamState_`.
    pub(crate) fn type_name(&self) -> &str {
        &self.type_name
    }
}

/// `package/msg/Name` is `package::msg::dds_::Name_` on the network.
fn dds_type(ros: &str, suffix: &str) -> String {
    match ros.rsplit_once('/') {
        Some((package, name)) => format!("{}::dds_::{name}{suffix}_", package.replace('/', "::")),
        None => format!("dds_::{ros}{suffix}_"),
    }
}

/// The participant and what its nodes own.
pub(crate) struct Participant {
    participant: DomainParticipant,
    publisher: Publisher,
    subscriber: Subscriber,
    graph: Graph,
}

impl Participant {
    /// Joins a ROS domain.
    pub(crate) fn join(domain: u16) -> Result<Self, TransportError> {
        let fail = |error: rustdds::dds::CreateError| TransportError::Participant { domain, reason: error.to_string() };
        let participant = DomainParticipantBuilder::new(domain).build().map_err(fail)?;
        let defaults = QosPolicyBuilder::new().build();
        let publisher = participant.create_publisher(&defaults).map_err(fail)?;
        let subscriber = participant.create_subscriber(&defaults).map_err(fail)?;
        let graph = Graph::new(&participant, &publisher)?;
        Ok(Self { participant, publisher, subscriber, graph })
    }

    /// Adds a node, which then can own endpoints by its full name.
    pub(crate) fn add_node(&mut self, namespace: &str, name: &str) -> Result<(), TransportError> {
        self.graph.add_node(namespace, name)
    }

    /// Tells the ROS graph about all nodes and endpoints made so far.
    pub(crate) fn announce(&self) -> Result<(), TransportError> {
        self.graph.announce()
    }

    /// Changes of the ROS graph, for the event loop.
    pub(crate) fn status(&self) -> StatusReader {
        StatusReader::new(self.participant.status_listener())
    }

    /// Opens a topic for writing.
    pub(crate) fn writer(&mut self, node: &str, name: &TopicName, qos: Qos) -> Result<NetworkWriter, TransportError> {
        Ok(NetworkWriter::new(self.data_writer(node, name, qos::writer(qos))?))
    }

    /// Opens a topic for reading.
    pub(crate) fn reader(&mut self, node: &str, name: &TopicName, qos: Qos) -> Result<NetworkReader, TransportError> {
        Ok(NetworkReader::new(self.data_reader(node, name, qos::reader(qos))?))
    }

    /// Tells the ROS graph that another node of this process reads by `reader` too.
    pub(crate) fn share_reader(&mut self, node: &str, reader: GUID) {
        self.graph.add(node, Endpoint::Reader(reader));
    }

    /// Opens the serving end of a service.
    pub(crate) fn server(&mut self, node: &str, service: &str, kind: &str) -> Result<ServiceServer, TransportError> {
        let requests = self.reader(node, &TopicName::request(service, kind), qos::SERVICE)?;
        let responses = self.writer(node, &TopicName::response(service, kind), qos::SERVICE)?;
        Ok(ServiceServer::new(requests, responses, self.participant.clone()))
    }

    /// Opens the calling end of a service.
    pub(crate) fn client(&mut self, node: &str, service: &str, kind: &str) -> Result<ServiceClient, TransportError> {
        let requests = self.writer(node, &TopicName::request(service, kind), qos::SERVICE)?;
        let responses = self.reader(node, &TopicName::response(service, kind), qos::SERVICE)?;
        Ok(ServiceClient::new(requests, responses))
    }

    fn data_writer(
        &mut self,
        node: &str,
        name: &TopicName,
        qos: QosPolicies,
    ) -> Result<DataWriter<RawMessage, RawAdapter>, TransportError> {
        let topic = self.topic(name, &qos)?;
        let writer = self
            .publisher
            .create_datawriter_no_key(&topic, Some(qos))
            .map_err(|error| TransportError::endpoint(&name.topic, &error))?;
        self.graph.add(node, Endpoint::Writer(writer.guid()));
        Ok(writer)
    }

    fn data_reader(
        &mut self,
        node: &str,
        name: &TopicName,
        qos: QosPolicies,
    ) -> Result<SimpleDataReader<RawMessage, RawAdapter>, TransportError> {
        let topic = self.topic(name, &qos)?;
        let reader = self
            .subscriber
            .create_simple_datareader_no_key(&topic, Some(qos))
            .map_err(|error| TransportError::endpoint(&name.topic, &error))?;
        self.graph.add(node, Endpoint::Reader(reader.guid()));
        Ok(reader)
    }

    fn topic(&self, name: &TopicName, qos: &QosPolicies) -> Result<Topic, TransportError> {
        self.participant
            .create_topic(name.topic.clone(), name.type_name.clone(), qos, TopicKind::NoKey)
            .map_err(|error| TransportError::endpoint(&name.topic, &error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_on_the_network_are_those_of_ros() {
        let check = |name: TopicName, topic: &str, type_name: &str| {
            assert_eq!((name.topic.as_str(), name.type_name.as_str()), (topic, type_name));
        };
        check(TopicName::message("/tf", "tf2_msgs/msg/TFMessage"), "rt/tf", "tf2_msgs::msg::dds_::TFMessage_");
        let ros = |topic: &str, type_name: &str| TopicName::ros_message(topic, type_name);
        let expected = Some(("/tf".to_owned(), "tf2_msgs/msg/TFMessage".to_owned()));
        assert_eq!(ros("rt/tf", "tf2_msgs::msg::dds_::TFMessage_"), expected);
        assert_eq!(ros("rq/a/armRequest", "std_srvs::srv::dds_::Trigger_Request_"), None);
        assert_eq!(ros("ros_discovery_info", "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_"), None);
        let trigger = "std_srvs/srv/Trigger";
        check(TopicName::request("/a/arm", trigger), "rq/a/armRequest", "std_srvs::srv::dds_::Trigger_Request_");
        check(TopicName::response("/a/arm", trigger), "rr/a/armReply", "std_srvs::srv::dds_::Trigger_Response_");
    }
}
