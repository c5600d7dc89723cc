//! A process's place in the shared memory of its host.

use super::{Header, SharedReader, SharedWriter, places};
use crate::transport::TransportError;
use iceoryx2::prelude::{
    Config, FileName, LogLevel, Node, NodeBuilder, Path, SemanticString, ServiceName, SignalHandlingMode, ipc,
    set_log_level,
};
use rustdds::mio1::{Registry, Token};
use std::env;
use trench_core::Qos;

/// The payload: CDR with its encapsulation header.
pub(super) type Topic = iceoryx2::service::port_factory::publish_subscribe::PortFactory<ipc::Service, [u8], Header>;

/// The iceoryx2 node of this process.
pub(crate) struct Host {
    node: Node<ipc::Service>,
    domain: u16,
}

/// A topic as shared memory names it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct SharedTopic(String);

impl Host {
    /// Joins this host's shared memory. What dead processes left is cleaned up.
    pub(crate) fn join(domain: u16) -> Result<Self, TransportError> {
        Self::join_apart(domain, &env::var("TRENCH_SHM_PREFIX").unwrap_or_default())
    }

    /// Joins those processes alone that use the same `prefix`.
    pub(super) fn join_apart(domain: u16, prefix: &str) -> Result<Self, TransportError> {
        let fail = |reason: String| TransportError::endpoint("shared memory", &reason);
        // Errors come back as values and are told in the node's name; iceoryx2's own lines would tell them twice.
        set_log_level(LogLevel::Fatal);
        let node = NodeBuilder::new()
            .config(&config(prefix).map_err(fail)?)
            .signal_handling_mode(SignalHandlingMode::Disabled)
            .create::<ipc::Service>()
            .map_err(|error| fail(format!("{error:?}")))?;
        Ok(Self { node, domain })
    }

    /// The name of a topic with its type: `/team_state` of type `trench_msgs/msg/TeamState`.
    pub(crate) fn topic(&self, topic: &str, type_name: &str) -> SharedTopic {
        SharedTopic(format!("trench/{}{topic}:{type_name}", self.domain))
    }

    /// Opens a topic for writing messages of `max_len` bytes (a longer one costs another memory).
    pub(crate) fn writer(&self, topic: &SharedTopic, max_len: usize, qos: Qos) -> Result<SharedWriter, TransportError> {
        SharedWriter::new(&self.node, &topic.service()?, max_len, qos)
            .map_err(|reason| TransportError::endpoint(&topic.0, &reason))
    }

    /// Opens a topic for reading by the reader that is `gid` on the network, to be waited for as `token` if there is one;
    /// `None` while no process of this host writes it.
    pub(crate) fn reader(
        &self,
        topic: &SharedTopic,
        qos: Qos,
        gid: [u8; 16],
        registry: &Registry,
        token: Option<Token>,
    ) -> Result<Option<SharedReader>, TransportError> {
        SharedReader::open(&self.node, &topic.service()?, qos, gid, registry, token)
            .map_err(|reason| TransportError::endpoint(&topic.0, &reason))
    }
}

impl SharedTopic {
    fn service(&self) -> Result<ServiceName, TransportError> {
        ServiceName::new(&self.0).map_err(|error| TransportError::endpoint(&self.0, &format!("{error:?}")))
    }
}

/// Files of our own name and folder: iceoryx2's default configuration would be looked for in the folder `config` of
/// wherever the process was started, and users of one host would meet in one folder.
fn config(prefix: &str) -> Result<Config, String> {
    let mut config = Config::default();
    let wrong = |error| format!("TRENCH_SHM_PREFIX is `{prefix}`: {error:?}; use letters and digits");
    config.global.prefix = FileName::new(places::file_prefix(prefix).as_bytes()).map_err(wrong)?;
    let root = places::folder(prefix);
    let root =
        Path::new(root.as_os_str().as_encoded_bytes()).map_err(|error| format!("{}: {error:?}", root.display()))?;
    config.global.set_root_path(&root);
    // Writers that died before a reader took their last messages. Books are kept for as many as may be, a few kB each and reader: of
    // iceoryx2's 128 a recorder of fifty topics had 37 MB.
    config.defaults.publish_subscribe.subscriber_expired_connection_buffer = 16;
    Ok(config)
}
