//! YAML with source positions, ROS 2 parameter files, and errors that name file, line, key and remedy.
//!
//! * [`yaml`] reads any configuration file (formations, cameras, scenarios, launch files) into nodes that know their
//!   line and their full key.
//! * [`params`] turns ROS 2 parameter files and `-p name:=value` into the [`Parameters`] of one node, checked against
//!   the [`ParameterDescriptor`]s that it declares.
//!
//! Nothing here reads a file: callers pass a name (for messages) and the text.

mod brief;
mod descriptor;
mod error;
mod parameters;
pub mod params;
mod suggest;
mod value;
pub mod yaml;

pub use descriptor::ParameterDescriptor;
pub use error::{ConfigError, Origin};
pub use parameters::Parameters;
pub use suggest::{did_you_mean, nearest};
pub use value::ParameterValue;
