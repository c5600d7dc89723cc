//! One node in its process: the core, what it reads and what it writes.

mod audience;
mod caller;
mod connect;
mod deliver;
mod early;
mod graph;
mod held;
mod notices;
mod parameters;
mod ports;
mod publication;
mod reference;
mod streams;
mod subscription;

pub(crate) use caller::Caller;
pub(crate) use connect::{Connections, Equipment, connect};
pub(crate) use ports::Ports;
pub(crate) use publication::Publication;
pub(crate) use subscription::Subscription;

use crate::transport::network::ServiceServer;
use notices::Notices;
use parameters::NodeParameters;
use reference::ClockReference;
use trench_core::NodeCore;

/// A running node.
pub(crate) struct Node {
    full_name: String,
    /// How many topics its core reads.
    subscribed: usize,
    core: Box<dyn NodeCore>,
    /// The clock that this node goes by, where it is not its own host's.
    reference: Option<ClockReference>,
    /// Tells its time to nodes of other hosts.
    time_server: Option<Box<dyn ServiceServer>>,
    parameters: NodeParameters,
    notices: Notices,
    ports: Ports,
}

/// What woke the loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wake {
    /// Shared memory of a topic that nodes of the process read.
    Topic(usize),
    /// Its network.
    Network(usize),
    /// Something that is one node's alone.
    Node(usize, NodeWake),
}

/// What woke the loop for one node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NodeWake {
    /// A service's requests.
    Requests(usize),
    /// A client's responses.
    Responses(usize),
    /// A byte stream.
    Stream(usize),
    /// Answers of the clock that the node goes by.
    ClockAnswers,
    /// Questions of nodes that go by this one's.
    ClockQuestions,
    /// One of the parameter services.
    Parameters(usize),
}
