//! Local minima of attraction and repulsion, and the ways out of them (7.6, 7.7, Remark 6.4.1).
//!
//! A [`Watch`] notices that a robot rests where forces cancel, (7.10). A [`Guard`] drawn before an apparent obstacle turns the
//! repulsion aside: [`auxiliary_arc`] where the nearest point moves along with the robot (Fig. 7.12), [`auxiliary_lines`] where it
//! does not (Fig. 7.13). [`escape`] leads out of a combined hull that has closed around a robot. [`ComparedRepulsion`] is what 7.8
//! compares with, [`GoalPotential`] and [`VelocityPotential`] what 5.5 does.
mod arc;
mod behind;
mod compared;
mod escape;
mod goal_potentials;
mod guard;
mod lines;
mod watch;

pub use arc::auxiliary_arc;
pub use behind::{behind_obstacles, is_obstructed};
pub use compared::ComparedRepulsion;
pub use escape::{escape, way_round};
pub use goal_potentials::{GoalPotential, VelocityPotential};
pub use guard::Guard;
pub use lines::auxiliary_lines;
pub use watch::{Watch, WatchSettings};
