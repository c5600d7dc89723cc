//! Drives all node cores in lock-step, from launch files or from journals.
//!
//! The one place that knows all cores (invariant 5).

mod admit;
mod bus;
pub mod catalog;
mod load;
mod lockstep;
pub mod replay;

pub use admit::refusals;
pub use bus::BusError;
/// Who gets which place, for those who judge formations before a run.
pub use leader_assignment::{ChainOrder, Seated, Seating, organise};
pub use load::{LoadError, Loaded, load, load_journalled, parameters, plan};
pub use lockstep::{Ending, Instance, Lockstep, Observer};
/// The localizer's eyes, for those who show what it sees.
pub use overhead_localizer::vision;
/// Obstacles of the test bed, for those who judge them.
pub use testbed::parse_obstacles;
/// What cores read while they are made in this process.
pub use trench_journal::Disk;
