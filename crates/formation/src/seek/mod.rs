//! Seeking the nearest point of a segment in the presence of obstacles (7.5).
//!
//! [`apparent_obstacles`] and [`Fragments::find`] are steps (1) to (3) of 7.5.2; a robot's [`Seeker`] does (4) to (6) on what
//! they leave, and decides on transits (Definition 7.2.1, Assumption 7.2.1); step (7) is to call it again.
mod apart;
mod fragments;
mod room;
mod seeker;
mod settings;

pub use apart::apparent_obstacles_apart;
pub use fragments::{Fragments, apparent_obstacles};
pub use room::Room;
pub use seeker::{LeaderView, Seeker, Sought};
pub use settings::{LeaderRule, SeekError, SeekSettings};
