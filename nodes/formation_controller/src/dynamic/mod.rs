//! The dynamic laws of chapters 5 to 7 on a robot that takes velocities (3.1.1).
//!
//! A law gives the acceleration of the point that is steered, `look_ahead` in front of the axle, which the feedback
//! linearisation makes a double integrator. Once a tick `trench_formation::agent` integrates it in steps of 1 ms up to the
//! next tick, with leaders, obstacles and the formation's frame moving on; the mean velocity of the point is what the
//! robot is told.

mod law;
mod potentials;
mod reference;
mod remedies;
mod settings;

pub(crate) use law::DynamicLaw;
pub(crate) use reference::Reference;
pub(crate) use settings::{DynamicSettings, check_damping, descriptors};
