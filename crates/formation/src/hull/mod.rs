//! Convex hulls, clearance, combined hulls (7.4).
mod outline;

pub use outline::{Approach, Outline};
