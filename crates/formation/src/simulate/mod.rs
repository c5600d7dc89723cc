//! Lock-step simulation of a chain of double integrators under (7.13).
//!
//! Semi-implicit Euler in fixed steps; what robots know of one another is sampled at ticks of several steps. Nothing is drawn at
//! random and sums have a fixed order: the same scenario gives the same bytes. Steps allocate nothing while the segment, or what
//! encroaches on it, rests.
mod carriage;
mod chain;
mod observe;
mod scenario;

pub use crate::agent::{Encroaching, Remedies};
pub use carriage::Carriage;
pub use chain::ChainSimulation;
pub use scenario::{ChainScenario, Options, ScenarioError};
