//! YAML with source positions, ROS 2 parameter files, and errors that name file, line, key and remedy.

mod error;
mod parameter;

pub use error::{ConfigError, Origin};
pub use parameter::{ParameterDescriptor, ParameterValue, Parameters};
