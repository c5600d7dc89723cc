//! Finds every robot's colour pad in the overhead camera's frames and publishes the team's state.

mod noise;
pub mod track;
pub mod vision;
