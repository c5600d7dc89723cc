//! Ways for CDR bytes between processes. Nodes do not know which one carries a message (architecture invariant 3).
//!
//! Architecture invariant: a writer hands each message to shared memory first and to the network second, with the same
//! count; a reader takes whichever comes first and drops the other.

pub(crate) mod dds;
mod delivered;
mod error;
pub(crate) mod shared_memory;

pub(crate) use delivered::Delivered;
pub use error::TransportError;
pub use shared_memory::forget_shared_memory;
