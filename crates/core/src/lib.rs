//! What every node core is.
//!
//! A node core is a state machine without I/O: it declares its [`Interface`], takes one [`Event`] at a time with the two
//! times of its arrival, and puts what it wants done into a [`Sink`]. A process (`trench_runtime`), the lock-step
//! simulator (`trench_harness`) and the bag checker drive the same core through this one trait.
//!
//! Architecture invariant: a core reads no clock, socket, file, thread or environment variable. Same construction and
//! same events, same calls on the sink, bit for bit.

pub mod arguments;
mod description;
mod event;
mod health;
mod interface;
mod jump;
mod latched;
mod marker;
mod master;
mod name;
mod node_core;
mod outbox;
mod refusals;
mod sink;
mod time;

pub use description::{Build, Files, NodeDescription};
pub use event::{Event, RequestId, Source};
pub use health::{Condition, Health};
pub use interface::{
    Advertise, ByteStream, Discovered, Durability, Interface, Local, Qos, Reliability, Serve, Subscribe,
};
pub use jump::{JumpWatch, jump_between};
pub use latched::Latched;
pub use marker::marker;
pub use master::{Master, NotMaster};
pub use name::resolve_name;
pub use node_core::{NodeContext, NodeCore, StartError};
pub use outbox::{Action, Outbox};
pub use refusals::Refusals;
pub use sink::{Level, Sink};
pub use time::{FromTheFuture, RosTime, Steady, Times, duration_from_seconds};
