//! Convex hulls, clearance, combined hulls (7.4).
//!
//! [`Shape`] is the apparent obstacle of one obstacle, [`combine`] joins those between which no robot can pass,
//! [`Outline`] measures distances from either.
mod area;
mod clip;
mod combine;
mod convex;
mod error;
mod nearer;
mod outline;
mod shape;

pub use area::RepulsiveArea;
pub use combine::{ApparentObstacle, Obstacle, combine, combine_unless};
pub use error::HullError;
pub(crate) use outline::Feature;
pub use outline::{Approach, Outline};
pub use shape::Shape;
