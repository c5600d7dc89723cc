//! The simulated test bed behind the real interfaces: camera frames out, serial bytes in.
//!
//! The world itself is `trench_sim`; this node gives it a clock, a pseudo-terminal and topics. Nodes under test get
//! frames (or the discs a perfect detector would see) and serial bytes; the truth goes to /ground_truth for evaluation.
//!
//! Architecture invariant: what happens in the bed depends on the seed and on the times of the bytes it receives alone.

mod core;
mod detections;
mod faults;
mod frames;
mod interface;
mod messages;
mod obstacles;
mod poses;
mod radio;
mod settings;
mod time;

pub use crate::core::Testbed;
pub use interface::description;
/// For those who judge such files.
pub use obstacles::parse as parse_obstacles;
