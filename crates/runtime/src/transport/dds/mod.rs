//! The network: ROS 2 topics and services over DDS.
//!
//! RustDDS's own readers and writers are used rather than ros2-client's, because those hide what the runtime needs: the
//! sequence number of a written sample, raw bytes, matches, and the send window. ros2-client gives the types that tell
//! the ROS graph about the endpoints.

mod announcements;
mod client;
mod graph;
mod image;
mod images;
mod long;
mod longest;
mod malformed;
mod name;
mod participant;
mod pause;
mod qos;
mod raw;
mod reader;
mod rtps;
mod server;
mod status;
mod writer;

pub(crate) use malformed::malformed_packets;
pub(crate) use participant::Participant;

use client::DdsClient;
use images::Images;
use name::DdsName;
use reader::DdsReader;
use server::DdsServer;
use writer::DdsWriter;
