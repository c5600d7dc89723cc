//! What this process tells the ROS graph: which node owns which endpoints (`ros_discovery_info`).

use super::raw::{LITTLE_ENDIAN, RawAdapter, RawMessage};
use crate::transport::TransportError;
use crate::transport::full_name;
use ros2_client::NodeName;
use ros2_client::entities_info::{NodeEntitiesInfo, ParticipantEntitiesInfo};
use rustdds::no_key::{DataWriter, SerializerAdapter};
use rustdds::{CDRSerializerAdapter, DomainParticipant, GUID, Publisher, RTPSEntity, TopicKind};
use std::collections::BTreeMap;
use std::fmt::Display;
use trench_core::Qos;

const TOPIC: &str = "ros_discovery_info";
const TYPE: &str = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";

/// An endpoint of a node.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Endpoint {
    Reader(GUID),
    Writer(GUID),
}

/// The nodes of this process and their endpoints.
pub(crate) struct Graph {
    participant: GUID,
    nodes: BTreeMap<String, NodeEntitiesInfo>,
    writer: DataWriter<RawMessage, RawAdapter>,
}

impl Graph {
    pub(super) fn new(participant: &DomainParticipant, publisher: &Publisher) -> Result<Self, TransportError> {
        let qos = super::qos::writer(Qos::LATCHED);
        let fail = |error| TransportError::endpoint(TOPIC, &error);
        let topic =
            participant.create_topic(TOPIC.to_owned(), TYPE.to_owned(), &qos, TopicKind::NoKey).map_err(fail)?;
        let writer = publisher.create_datawriter_no_key(&topic, Some(qos)).map_err(fail)?;
        Ok(Self { participant: participant.guid(), nodes: BTreeMap::new(), writer })
    }

    /// Adds a node without endpoints.
    pub(super) fn add_node(&mut self, namespace: &str, name: &str) -> Result<(), TransportError> {
        let node = NodeName::new(namespace, name).map_err(|error| TransportError::NodeName {
            namespace: namespace.to_owned(),
            name: name.to_owned(),
            error,
        })?;
        self.nodes.insert(full_name(namespace, name), NodeEntitiesInfo::new(node));
        Ok(())
    }

    /// Gives an endpoint to a node. Not told to anyone before [`Graph::announce`].
    pub(super) fn add(&mut self, node: &str, endpoint: Endpoint) {
        if let Some(info) = self.nodes.get_mut(node) {
            match endpoint {
                Endpoint::Reader(guid) => info.add_reader(guid.into()),
                Endpoint::Writer(guid) => info.add_writer(guid.into()),
            }
        }
    }

    /// Tells everyone, late joiners too.
    pub(super) fn announce(&self) -> Result<(), TransportError> {
        let info = ParticipantEntitiesInfo::new(self.participant.into(), self.nodes.values().cloned().collect());
        let fail = |error: &dyn Display| TransportError::endpoint(TOPIC, &error);
        let body = CDRSerializerAdapter::<ParticipantEntitiesInfo>::to_bytes(&info).map_err(|error| fail(&error))?;
        let message = RawMessage([&LITTLE_ENDIAN[..], &body].concat().into()).in_whole_words();
        self.writer.write(message, None).map_err(|error| fail(&error))
    }
}
