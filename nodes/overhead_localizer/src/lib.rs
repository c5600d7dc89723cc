//! Finds every robot's colour pad in the overhead camera's frames and publishes the team's state (4.5.3).
//!
//! | stage | where |
//! |---|---|
//! | pixels to discs | [`vision`] |
//! | discs to pads, pads to robots, one filter a robot | [`track`] |
//! | frames in, messages out | [`OverheadLocalizer`] |
//!
//! Architecture invariant: pixels appear only here and in the renderer; everything published is in the map.

mod core;
mod frozen;
mod gather;
mod intake;
mod markers;
mod memory;
mod messages;
mod missing;
mod naming;
mod noise;
mod pads;
mod recalibrate;
mod refusal;
mod report;
mod settings;
mod stream;
pub mod track;
pub mod vision;

pub use crate::core::{OverheadLocalizer, description};
