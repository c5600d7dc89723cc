//! Turns obstacles into apparent obstacles (7.4).
//!
//! Every obstacle is replaced by its convex hull (7.6); hulls nearer to each other than the clearance are combined, and
//! the combined ones again, until no two are (7.8). What each controller adds to them, the robots ahead of it, differs
//! from robot to robot (7.5) and is the controller's business.
//!
//! | stage | where |
//! |---|---|
//! | publishers of obstacles: order, motion, who has gone | `sources` |
//! | robots' poses at the times of their scans | `team` |
//! | scans to points of the map, without robots' bodies | `scans/intake` |
//! | points kept for a while, cleared where rays pass | `scans/memory` |
//! | points to partial boundaries (Remark 7.4.1) that keep their ids | `scans/clusters` |
//! | lasers that fall silent while their robots drive on | `scans/watch` |
//! | walls that bend leave corridors open (9.2) | `scans/walls` |
//! | pictures | `markers` |

mod core;
mod markers;
mod report;
mod scans;
mod settings;
mod sources;
mod team;

pub use crate::core::{ObstacleMapper, description};
