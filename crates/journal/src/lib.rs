//! Journals: what a node's core was told and what it did about it, in the order in which it happened.
//!
//! A journal begins with all that the core was made from ([`Start`]); then comes one step an event: the event by value
//! with both of its times, and every output. [`build`] makes a core that keeps one, in a process or in lock-step;
//! [`JournalReader`] reads it back, so that a core made anew can be fed the same events (architecture invariant 11).
//!
//! The container is MCAP: chunked, compressed, checksummed. A step is one message of the channel `steps`, numbered
//! without gaps; its log time is the event's monotonic time, its publish time the event's ROS time.

mod disk;
mod error;
mod file;
mod journal;
mod journalled;
mod kept_files;
mod make;
mod queue;
mod reader;
mod record;
mod start;
mod value;
mod witness;

pub use disk::Disk;
pub use error::JournalError;
pub use journal::Journal;
pub use journalled::Journalled;
pub use kept_files::{KeptFiles, RecordedFiles};
pub use make::{BuildError, Journals, Pace, build};
pub use reader::{Break, JournalReader, Step, Steps};
pub use record::{End, Input, Output, Payload, Record, Records};
pub use start::{FileText, Parameter, Port, Ports, Start};
pub use witness::Witness;

#[cfg(test)]
mod tests;
