//! One node in its process: the core, what it reads and what it writes.

mod audience;
mod caller;
mod connect;
mod deliver;
mod early;
mod graph;
mod held;
mod parameters;
mod ports;
mod publication;
mod streams;
mod subscription;

pub(crate) use caller::Caller;
pub(crate) use connect::{Connections, Equipment, connect};
pub(crate) use ports::Ports;
pub(crate) use publication::Publication;
pub(crate) use subscription::Subscription;

use parameters::NodeParameters;
use trench_core::NodeCore;

/// A running node.
pub(crate) struct Node {
    full_name: String,
    core: Box<dyn NodeCore>,
    subscriptions: Vec<Subscription>,
    clock: Option<Subscription>,
    parameters: NodeParameters,
    ports: Ports,
}

/// What woke the loop for a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wake {
    /// /clock.
    Clock,
    /// A subscription.
    Messages(usize),
    /// A service's requests.
    Requests(usize),
    /// A client's responses.
    Responses(usize),
    /// A byte stream.
    Stream(usize),
    /// One of the parameter services.
    Parameters(usize),
}
