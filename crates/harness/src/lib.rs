//! Drives all node cores in lock-step, from launch files or from journals.
//!
//! The one place that knows all cores (invariant 5).

mod bus;
mod lockstep;

pub use bus::BusError;
pub use lockstep::{Ending, Instance, Lockstep, Observer};
