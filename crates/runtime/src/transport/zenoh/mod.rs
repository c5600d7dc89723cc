//! The network: ROS 2 topics and services over Zenoh, on the wire of rmw_zenoh.
//!
//! A topic is a key expression that holds the domain, the name, the type and its hash; a liveliness token tells the
//! graph of each node and each end of a topic or service; an attachment beside each message says its count, its time
//! and its writer. The crate zenoh is used directly rather than through ros2-client, whose publishers know the hashes
//! of a few types alone and whose queues block Zenoh's threads.
//!
//! Zenoh calls back on threads of its own: a callback puts what came into a bounded [`inbox`] and wakes the loop, no
//! more.

mod attachment;
mod client;
mod configuration;
mod entity;
mod graph;
mod inbox;
mod long;
mod qos;
mod reader;
mod router;
mod routers;
mod server;
mod session;
mod writer;

pub use router::{RouterError, route};
pub(crate) use session::Session;

use entity::{Entity, Kind};
