//! Messages between processes of one host without a copy, through iceoryx2.
//!
//! Each topic is one service, made by its writers: a publish-subscribe part with the messages and an event part that
//! wakes the readers. A reader opens what exists and goes on with the network where nothing does.

mod header;
mod host;
mod identity;
mod limits;
mod places;
mod reader;
mod writer;

pub(crate) use host::{Host, SharedTopic};
pub use places::forget_shared_memory;
pub(crate) use reader::{SharedReader, SharedSample};
pub(crate) use writer::SharedWriter;

use header::Header;

#[cfg(test)]
mod tests;
