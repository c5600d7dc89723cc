//! Zoning potentials of chapters 6 and 7: how far a follower keeps from its leader, the robots ahead of it, and obstacles.
//!
//! d-vectors point from the robot to the other; a force is +Psi'(d) along the unit vector towards the other. Potentials
//! count from 0 in the neutral zone: the thesis's constants c1/2 and c2/2 there act on nothing.
mod barrier;
mod obstacle;
mod potential;
mod radii;

pub use obstacle::{ObstaclePotential, ObstaclePotentialError};
pub use potential::{Edge, Sharpness, Zoning, ZoningError};
pub use radii::{Radii, RadiiError, Zone};
