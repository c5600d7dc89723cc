//! The theory of the thesis, pure: no I/O, no clock, no message types.
//!
//! Chapters: [`kinematics`] and [`laws`] 3 and 4, [`stability`] 4.3 and 8, [`curve`] 2.1 and 7.2, [`trench`] 5,
//! [`zoning`] 6, [`hull`] 7.4, [`seek`] 7.5,
//! [`avoidance`] 7.6 and 7.7, [`compared`] 7.8, [`assignment`] and [`chain`] 2.1, 6.2.1, [`safety`] docs/ARCHITECTURE.md;
//! [`agent`] is one robot's controller for the dynamic laws, [`simulate`] runs many in lock-step.
//!
//! Units are SI, angles radians, frames `map` unless a name says otherwise.
pub use nalgebra::Vector2;

pub mod agent;
pub mod assignment;
pub mod avoidance;
pub mod chain;
pub mod compared;
pub mod curve;
pub mod hull;
pub mod kinematics;
mod lanes;
pub mod laws;
mod quadrature;
pub mod safety;
pub mod seek;
pub mod simulate;
pub mod stability;
pub mod trench;
pub mod zoning;
