//! Formations as people write them and as messages carry them, turned into the theory's curves.
//!
//! A formation file names queues Q = (S, X, C, epsilon) of Definition 2.1.1: segment, vertices, share, tolerance; and, for
//! experiments like those of 4.6, the starts of the virtual points that move to the vertices.

mod file;
mod plan;
mod sample;
mod segment;

pub use file::parse;
pub use plan::{Frame, Motion, Place, Plan, QueuePlan};
pub use sample::sampled;
pub use segment::{SegmentError, curve_from_message, shape_from_message};
