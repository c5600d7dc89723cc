//! What changes in the ROS graph around this process.

use super::Gid;
use rustdds::mio1::event;
use std::collections::BTreeSet;
use trench_core::Qos;

/// A change that nodes or their operator want to know of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum GraphChange {
    /// The number of writers matched to a reader changed.
    Matched { reader: Gid, writers: usize },
    /// A writer was matched to a reader, or has gone; [`GraphChange::Matched`] follows.
    Presence { reader: Gid, writer: Gid, is_there: bool },
    /// The readers matched to a writer changed.
    Readers { writer: Gid, readers: BTreeSet<Gid> },
    /// Another process writes a topic that some reader here may read. The type is the network's own word for it where
    /// it is none of ROS, its hash empty where it is not told.
    Writer { topic: String, type_name: String, type_hash: String, qos: Qos },
    /// A reader here and a writer cannot talk: its quality of service does not suffice.
    Incompatible { reader: Gid, writer: Gid },
    /// The connection to a router, over which this process reaches others, is gone, or there again. The router is named by where it
    /// listens.
    Router { at: String, is_there: bool },
}

/// Follows the matches of all readers and writers of this process.
pub(crate) trait GraphWatch: event::Source {
    /// All changes since the last call.
    fn take(&mut self) -> Vec<GraphChange>;
}
