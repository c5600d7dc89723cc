//! What can go wrong with a transport when a process starts.

use std::fmt::Display;

/// Why a process cannot be connected.
#[derive(Debug, thiserror::Error)]
pub enum TransportError {
    /// The network itself.
    #[error("cannot join DDS domain {domain}: {reason}; check ROS_DOMAIN_ID and the network interfaces")]
    Participant {
        /// The ROS domain.
        domain: u16,
        /// What the DDS implementation says.
        reason: String,
    },
    /// The network, where it is secured.
    #[error(
        "cannot join DDS domain {domain} as the enclave in {folder}: {reason}; check its certificates, governance and permissions"
    )]
    Enclave {
        /// The ROS domain.
        domain: u16,
        /// Of the enclave's files.
        folder: String,
        /// What the DDS implementation says.
        reason: String,
    },
    /// The network, where it is Zenoh.
    #[error("cannot join Zenoh: {reason}; check ZENOH_SESSION_CONFIG_URI and ZENOH_CONFIG_OVERRIDE")]
    Zenoh {
        /// What Zenoh says.
        reason: String,
    },
    /// One topic or service.
    #[error("cannot open {name}: {reason}")]
    Endpoint {
        /// The topic or service.
        name: String,
        /// What the transport says.
        reason: String,
    },
    /// The node's name is not one that ROS 2 allows.
    #[error("{namespace}/{name} cannot name a node: {error}; use letters, digits and underscores, no leading digit")]
    NodeName {
        /// The namespace.
        namespace: String,
        /// The name.
        name: String,
        /// What is wrong.
        error: ros2_client::names::NameError,
    },
    /// The operating system refuses something the event loop needs.
    #[error("{what}: {source}")]
    System {
        /// What was tried.
        what: &'static str,
        /// What the system says.
        source: std::io::Error,
    },
}

impl TransportError {
    pub(crate) fn endpoint(name: &str, reason: &impl Display) -> Self {
        Self::Endpoint { name: name.to_owned(), reason: reason.to_string() }
    }
}
