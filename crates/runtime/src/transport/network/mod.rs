//! What every network is to the rest of the runtime: DDS and Zenoh alike.
//!
//! Nothing here ever blocks: what cannot be sent now waits or is refused, and what arrives wakes the event loop.

mod graph;
mod images;
mod lane;
mod pace;
mod topic;

pub(crate) use graph::{GraphChange, GraphWatch};
pub(crate) use images::ImageWay;
pub(crate) use lane::Lane;
pub(crate) use pace::Pace;
pub(crate) use topic::TopicName;

use super::TransportError;
use rustdds::bytes::Bytes;
use rustdds::mio1::event;
use std::collections::BTreeSet;
use std::time::Duration;
use trench_core::{Qos, Source, Steady};
use trench_msgs::ServiceInfo;

/// An end of a topic or service on the network.
pub(crate) type Gid = [u8; 16];

/// A message from the network.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct NetworkSample {
    /// Writer and count.
    pub(crate) source: Source,
    /// CDR with its header.
    pub(crate) cdr: Bytes,
    /// When it came.
    pub(crate) arrived: Steady,
}

/// The network can take no more: the readers are thousands of messages behind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Congested;

/// Why a response was not sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(crate) enum NotSent {
    /// The clients acknowledge nothing any more.
    #[error("its clients are more than 8192 responses behind")]
    Congested,
    /// More than a datagram takes.
    #[error("its {0} bytes are more than a datagram takes, 65000: ask for less at once")]
    TooLong(usize),
    /// The host's network refuses it.
    #[error("the network refuses it: {0}")]
    Network(std::io::ErrorKind),
}

/// Whom to answer: the client and its count of the request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct PendingRequest {
    pub(crate) client: Gid,
    pub(crate) count: i64,
}

/// A process's place on a network, for all its nodes.
pub(crate) trait Network {
    /// Adds a node, which then can own endpoints by its full name.
    fn add_node(&mut self, namespace: &str, name: &str) -> Result<(), TransportError>;

    /// Tells the ROS graph about all nodes and endpoints made so far.
    fn announce(&mut self) -> Result<(), TransportError>;

    /// Endpoints are to be opened although the process runs: asks for the moment in which that does no harm.
    fn prepare_to_open(&mut self) {}

    /// Whether it is now, until [`Network::announce`].
    fn is_prepared(&self) -> bool {
        true
    }

    /// Opens a topic for writing.
    fn writer(&mut self, node: &str, name: &TopicName, qos: Qos) -> Result<Box<dyn NetworkWriter>, TransportError>;

    /// Opens a topic for reading.
    fn reader(&mut self, node: &str, name: &TopicName, qos: Qos) -> Result<Box<dyn NetworkReader>, TransportError>;

    /// Tells the ROS graph that another node of this process reads by `reader` too, where the network has a word for it.
    fn share_reader(&mut self, node: &str, reader: Gid);

    /// Opens the serving end of a service.
    fn server(
        &mut self,
        node: &str,
        service: &str,
        info: ServiceInfo,
    ) -> Result<Box<dyn ServiceServer>, TransportError>;

    /// Opens the calling end of a service.
    fn client(
        &mut self,
        node: &str,
        service: &str,
        info: ServiceInfo,
    ) -> Result<Box<dyn ServiceClient>, TransportError>;
}

/// Writes messages in order.
pub(crate) trait NetworkWriter {
    /// This writer's identity on the network.
    fn gid(&self) -> Gid;

    /// Whether a message would be taken now.
    fn has_room(&self) -> bool;

    /// Takes a message (CDR with its header) for sending and gives its count.
    fn write(&mut self, message: Bytes) -> Result<u64, Congested>;

    /// Takes a message that is number `count` of its writer, where the network did not get all before it.
    fn write_counted(&mut self, message: Bytes, count: u64) -> Result<(), Congested>;

    /// The longest message that can carry its count, bytes.
    fn longest_counted(&self) -> usize;

    /// Sends what waits; true when nothing waits any longer.
    fn flush(&mut self) -> bool;

    /// Waits until the readers have everything, or time is over.
    fn settle(&mut self, max_wait: Duration);

    /// Images ([`ImageWay`]) may take so many bit/s from now on; without this, as many as there are.
    fn limit(&mut self, rate: f64);

    /// Follows whom only the network reaches.
    fn readers_changed(&mut self, readers: &BTreeSet<Gid>);
}

/// Takes messages in the order of each writer.
pub(crate) trait NetworkReader: event::Source {
    /// This reader's identity on the network.
    fn gid(&self) -> Gid;

    /// Acknowledges the wake-up; to be called before taking, or a later arrival may go unnoticed.
    fn clear_wakeup(&self);

    /// The next message, or what is wrong with it; `None` when all are taken.
    fn take(&self) -> Option<Result<NetworkSample, String>>;
}

/// Takes requests and sends responses.
pub(crate) trait ServiceServer: event::Source {
    /// As [`NetworkReader::clear_wakeup`].
    fn clear_wakeup(&self);

    /// The next request (CDR with its header), or what is wrong with it.
    fn take(&mut self) -> Option<Result<(PendingRequest, Bytes), String>>;

    /// Answers a request.
    fn respond(&mut self, request: PendingRequest, response: Bytes) -> Result<(), NotSent>;

    /// Follows who reads what `writer` writes.
    fn readers_changed(&mut self, writer: &Gid, readers: &BTreeSet<Gid>);

    /// Sends what waits; true when nothing waits any longer.
    fn flush(&mut self) -> bool;
}

/// Sends requests and takes their responses.
pub(crate) trait ServiceClient: event::Source {
    /// As [`NetworkReader::clear_wakeup`].
    fn clear_wakeup(&self);

    /// Whether a server is there, both to hear and to answer.
    fn is_ready(&self) -> bool;

    /// Sends a request (CDR with its header) and gives its count.
    fn call(&mut self, request: Bytes) -> Result<u64, Congested>;

    /// The next response to one of our own requests with that request's count, or what is wrong with it.
    fn take(&mut self) -> Option<Result<(u64, Bytes), String>>;

    /// Follows who reads what `writer` writes.
    fn readers_changed(&mut self, writer: &Gid, readers: &BTreeSet<Gid>);

    /// Follows how many write what `reader` reads.
    fn writers_changed(&mut self, reader: &Gid, writers: usize);

    /// Sends what waits; true when nothing waits any longer.
    fn flush(&mut self) -> bool;
}
