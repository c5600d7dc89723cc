//! Formations as people write them and as messages carry them, turned into the theory's curves.
//!
//! A formation file names queues Q = (S, X, C, epsilon) of Definition 2.1.1: segment, vertices, share, tolerance; and, for
//! experiments like those of 4.6, the starts of the virtual points that move to the vertices.

mod chain;
mod expression;
mod file;
mod message;
mod plan;
mod sample;
mod scale;
mod segment;
mod trench;

pub use chain::{ChainPlaces, NoRoom};
pub use expression::{expression, expression_remedy};
pub use file::{angle, parse, segment};
pub use message::{FormationError, plan_from_message};
pub use plan::{Frame, Motion, Place, Plan, QueuePlan};
pub use sample::sampled;
pub use segment::{SegmentError, curve_from_message, message_from_shape, shape_from_message};
pub use trench::{TRENCH_RANGE, TRENCH_SHAPES, trench_from_parameters};

/// Vertices and starts may lie this far from their segment, m: rounding in the file, no more.
pub const ON_SEGMENT: f64 = 1e-3;

/// Shares may miss 1 by this much: rounding of thirds in the file.
const SHARES: f64 = 0.005;

/// Robots of one chain, at most: a message that asks for more is a mistake.
const MOST_ROBOTS: u32 = 10_000;

/// m. Localisation errs by millimetres: no robot conforms more closely than this but by chance, and with none at all a robot that has
/// lost its team would never be on its segment (Remark 6.2.1).
const LEAST_TOLERANCE: f64 = 1e-3;

/// What a queue without a vertex lacks.
const NO_VERTEX: &str = "a queue without a vertex (Definition 2.1.1 has one or two): the first is the team goal, to which its leader goes \
                         and from which the others are ranked";

/// What a chain does with several vertices.
const ONE_VERTEX: &str = "a chain has one vertex, the team goal: its places follow from that one and its spacing";
