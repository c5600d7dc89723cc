//! Ways for CDR bytes between processes. Nodes do not know which one carries a message (architecture invariant 3).
//!
//! Architecture invariant: a writer hands each message to shared memory first and to the network second, with the same
//! count; a reader takes whichever comes first and drops the other.

mod backend;
mod dds;
mod delivered;
mod error;
pub(crate) mod network;
pub(crate) mod shared_memory;
mod zenoh;

pub(crate) use backend::Backend;
pub(crate) use dds::malformed_packets;
pub(crate) use delivered::Delivered;
pub use error::TransportError;
pub use shared_memory::forget_shared_memory;
pub use zenoh::{RouterError, route};

/// `/robot1` and `controller` make `/robot1/controller`.
pub(crate) fn full_name(namespace: &str, name: &str) -> String {
    format!("{}/{name}", namespace.trim_end_matches('/'))
}
