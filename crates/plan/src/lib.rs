//! Formations as people write them and as messages carry them, turned into the theory's curves.
//!
//! A formation file names queues Q = (S, X, C, epsilon) of Definition 2.1.1: segment, vertices, share, tolerance; and, for
//! experiments like those of 4.6, the starts of the virtual points that move to the vertices.

mod expression;
mod file;
mod message;
mod plan;
mod sample;
mod scale;
mod segment;
mod trench;

pub use expression::{expression, expression_remedy};
pub use file::{parse, segment};
pub use message::{FormationError, plan_from_message};
pub use plan::{ChainPlaces, Frame, Motion, Place, Plan, QueuePlan};
pub use sample::sampled;
pub use segment::{SegmentError, curve_from_message, message_from_shape, shape_from_message};
pub use trench::{TRENCH_RANGE, TRENCH_SHAPES, trench_from_parameters};

/// Vertices and starts may lie this far from their segment, m: rounding in the file, no more.
const ON_SEGMENT: f64 = 1e-3;

/// Shares may miss 1 by this much: rounding of thirds in the file.
const SHARES: f64 = 0.005;

/// Robots of one chain, at most: a message that asks for more is a mistake.
const MOST_ROBOTS: u32 = 10_000;
