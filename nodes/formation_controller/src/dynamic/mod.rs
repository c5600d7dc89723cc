//! The dynamic laws of chapters 5 to 7 on a robot that takes velocities (3.1.1).
//!
//! A law gives the acceleration of the point that is steered, `look_ahead` in front of the axle, which the feedback
//! linearisation makes a double integrator. Once a tick the law is integrated in steps of 1 ms up to the next tick, with
//! leaders, obstacles and the formation's frame moving on; the mean velocity of the point is what the robot is told.

mod agent;
mod around;
mod law;
mod settings;
mod trench;

pub(crate) use agent::Agent;
pub(crate) use around::{Ahead, Around, Frame, MovingHull};
pub(crate) use law::DynamicLaw;
pub(crate) use settings::{DynamicSettings, Encroaching, check_damping, descriptors};
