//! One robot's controller under the dynamic laws of chapters 5 to 7: what a live process and a simulation run alike.
//!
//! An [`Agent`] remembers what one robot has to: the nearest point it keeps, its qualified fragments, its remedy. Once a tick
//! it senses its [`Surroundings`]; between ticks it steers in small steps, with everything around it carried on by its
//! velocity. All is in frame `map`. Steering allocates nothing but where a remedy begins. What lies on the way from a
//! robot's surroundings to its acceleration is inlined into one function: what a caller does not look at is not computed.
mod abreast;
mod action;
mod attract;
mod controller;
mod encroach;
mod law;
mod places;
mod remedy;
mod risen;
mod settings;
mod surroundings;

pub(crate) use abreast::{Abreast, Side};
pub use action::{Action, Driven, Forces, Powers, RemedyState, Values, Work};
pub use controller::Agent;
pub use settings::{AgentSettings, Encroaching, Method, Remedies};
pub(crate) use surroundings::Moment;
pub use surroundings::{Leader, Surroundings};
