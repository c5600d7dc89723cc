//! Plays the operator of a run: arms, starts, watches, stops, and says whether the formation stood.
//!
//! Launch files start it beside the nodes; its exit code is the run's verdict. It is what a person with
//! `ros2 service call` would do, and nothing in the stack depends on it.

mod conduct;
mod core;
mod progress;
mod route;
mod settings;

pub use conduct::{Conduct, Step, Verdict};
pub use core::{Operator, description};
pub use progress::{Distances, distances, shape_error};
pub use route::Route;
