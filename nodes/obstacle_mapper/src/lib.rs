//! Turns obstacles into apparent obstacles (7.4).
//!
//! Every obstacle is replaced by its convex hull (7.6); hulls nearer to each other than the clearance are combined, and
//! the combined ones again, until no two are (7.8). What each controller adds to them, the robots ahead of it, differs
//! from robot to robot (7.5) and is the controller's business.

mod core;
mod markers;
mod sources;

pub use crate::core::{ObstacleMapper, description};
pub use sources::Sources;
