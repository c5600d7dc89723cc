//! A process's place on the network: one Zenoh session for all its nodes.

use super::client::ZenohClient;
use super::configuration;
use super::entity::{NodeToken, all_tokens, gid};
use super::graph::{Graph, News, TokenChange};
use super::inbox::{Inbox, Outlet};
use super::long::LongWay;
use super::reader::ZenohReader;
use super::routers::ConnectionChange;
use super::server::ZenohServer;
use super::writer::ZenohWriter;
use super::{Entity, Kind};
use crate::transport::network::{
    Gid, GraphWatch, Network, NetworkReader, NetworkWriter, ServiceClient, ServiceServer, TopicName,
};
use crate::transport::{TransportError, full_name};
use std::collections::BTreeMap;
use std::sync::Arc;
use trench_core::{Durability, Qos, Reliability};
use trench_msgs::ServiceInfo;
use zenoh::Wait;
use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::Subscriber;
use zenoh::sample::SampleKind;

/// Tokens that wait for the loop: those of a large team's whole graph.
const TOKENS: usize = 65_536;

/// ROS 2's default for services.
const SERVICE: Qos = Qos { reliability: Reliability::Reliable, durability: Durability::Volatile, depth: 10 };

/// The session and what its nodes own.
pub(crate) struct Session {
    session: zenoh::Session,
    domain: u16,
    nodes: BTreeMap<String, NodeToken>,
    /// Nodes and ends share one count.
    next_number: u64,
    tokens: Vec<LivelinessToken>,
    graph: Outlet<News>,
    long_way: Arc<LongWay>,
    _watch: Subscriber<()>,
}

impl Session {
    /// Joins a ROS domain.
    pub(crate) fn join(domain: u16) -> Result<(Self, Box<dyn GraphWatch>), TransportError> {
        let fail = |reason: String| TransportError::Zenoh { reason };
        let system = |source| TransportError::System { what: "cannot make a wake-up", source };
        let config = configuration::session().map_err(fail)?;
        let session = zenoh::open(config).wait().map_err(|error| fail(error.to_string()))?;
        let (inbox, outlet) = Inbox::new(TOKENS).map_err(system)?;
        let name = session.zid().to_string();
        let heard = outlet.clone();
        let watch = session.liveliness().declare_subscriber(all_tokens(domain)).history(true);
        let watch = watch
            .callback(move |sample| {
                let (key, alive) = (sample.key_expr().as_str().to_owned(), sample.kind() == SampleKind::Put);
                heard.put(News::Token(TokenChange { key, alive }));
            })
            .wait()
            .map_err(|error| fail(error.to_string()))?;
        watch_routers(&session, &outlet).map_err(|error| fail(error.to_string()))?;
        let session = Self {
            session,
            domain,
            nodes: BTreeMap::new(),
            next_number: 0,
            tokens: Vec::new(),
            graph: outlet,
            long_way: Arc::default(),
            _watch: watch,
        };
        Ok((session, Box::new(Graph::new(name, inbox))))
    }

    fn number(&mut self) -> u64 {
        let number = self.next_number;
        self.next_number += 1;
        number
    }

    /// Opens an end of a topic or service of a node: `open` gets the key expression of its data, its identity, and what
    /// makes its token.
    fn open<T>(
        &mut self,
        node: &str,
        entity: &Entity,
        open: impl FnOnce(&zenoh::Session, String, Gid, &dyn Fn() -> zenoh::Result<LivelinessToken>) -> zenoh::Result<T>,
    ) -> Result<T, TransportError> {
        let number = self.number();
        let owner =
            self.nodes.get(node).ok_or_else(|| TransportError::endpoint(&entity.name, &"its node is unknown"))?;
        let key = owner.entity_key(number, entity);
        let declare = || self.session.liveliness().declare_token(key.clone()).wait();
        let opened = open(&self.session, entity.data_key(self.domain), gid(&key), &declare)
            .map_err(|error| TransportError::endpoint(&entity.name, &error))?;
        // Our own tokens are known before the network repeats them.
        self.graph.put(News::Token(TokenChange { key, alive: true }));
        Ok(opened)
    }
}

/// Has the loop told of connections for as long as the session lives.
fn watch_routers(session: &zenoh::Session, outlet: &Outlet<News>) -> zenoh::Result<()> {
    let tell = |outlet: &Outlet<News>, change: Option<ConnectionChange>| {
        change.into_iter().for_each(|change| outlet.put(News::Connection(change)));
    };
    let (info, heard) = (session.info(), outlet.clone());
    let links = info.link_events_listener().history(true);
    links.callback(move |event| tell(&heard, ConnectionChange::of_link(&event))).background().wait()?;
    let heard = outlet.clone();
    let transports = info.transport_events_listener().history(true);
    transports.callback(move |event| tell(&heard, ConnectionChange::of_transport(&event))).background().wait()
}

impl Network for Session {
    fn add_node(&mut self, namespace: &str, name: &str) -> Result<(), TransportError> {
        ros2_client::NodeName::new(namespace, name).map_err(|error| TransportError::NodeName {
            namespace: namespace.to_owned(),
            name: name.to_owned(),
            error,
        })?;
        let (number, session) = (self.number(), self.session.zid().to_string());
        // The root is written as nothing.
        let written = namespace.trim_end_matches('/').to_owned();
        let node = NodeToken { domain: self.domain, session, number, namespace: written, name: name.to_owned() };
        let token = self.session.liveliness().declare_token(node.key()).wait();
        self.tokens.push(token.map_err(|error| TransportError::endpoint(name, &error))?);
        self.nodes.insert(full_name(namespace, name), node);
        Ok(())
    }

    /// Tokens have told the graph already.
    fn announce(&mut self) -> Result<(), TransportError> {
        Ok(())
    }

    fn writer(&mut self, node: &str, name: &TopicName, qos: Qos) -> Result<Box<dyn NetworkWriter>, TransportError> {
        let entity = Entity::new(Kind::Publisher, name.topic(), name.type_name(), name.type_hash(), qos);
        let long_way = Arc::clone(&self.long_way);
        let writer = self.open(node, &entity, |session, key, gid, token| {
            ZenohWriter::open(session, key, qos, gid, long_way, token)
        })?;
        Ok(Box::new(writer))
    }

    fn reader(&mut self, node: &str, name: &TopicName, qos: Qos) -> Result<Box<dyn NetworkReader>, TransportError> {
        let entity = Entity::new(Kind::Subscription, name.topic(), name.type_name(), name.type_hash(), qos);
        let reader =
            self.open(node, &entity, |session, key, gid, token| ZenohReader::open(session, key, qos, gid, token))?;
        Ok(Box::new(reader))
    }

    /// A token would be a reader of its own to every writer, whom shared memory does not serve: only the node that opened
    /// the topic shows it.
    fn share_reader(&mut self, _node: &str, _reader: Gid) {}

    fn server(
        &mut self,
        node: &str,
        service: &str,
        info: ServiceInfo,
    ) -> Result<Box<dyn ServiceServer>, TransportError> {
        let entity = Entity::new(Kind::Server, service, info.name, info.hash, SERVICE);
        let server = self.open(node, &entity, |session, key, _, token| ZenohServer::open(session, key, token))?;
        Ok(Box::new(server))
    }

    fn client(
        &mut self,
        node: &str,
        service: &str,
        info: ServiceInfo,
    ) -> Result<Box<dyn ServiceClient>, TransportError> {
        let entity = Entity::new(Kind::Client, service, info.name, info.hash, SERVICE);
        let client =
            self.open(node, &entity, |session, key, gid, token| ZenohClient::open(session, key, gid, token))?;
        Ok(Box::new(client))
    }
}
