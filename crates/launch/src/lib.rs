//! ROS 2 launch files in YAML: parse, resolve, start and supervise.
//!
//! [`resolve`] turns a launch file into a [`Plan`]: the processes with their arguments, parameter files and variables,
//! exactly those that the real `ros2 launch` would start (`docs/launch.md` names the subset and the differences).
//! [`supervise`] runs a plan. Only these two touch the outside: `resolve` reads files, `supervise` starts processes.

mod dump;
mod literal;
mod package;
mod parse;
mod plan;
mod report;
mod resolve;
mod scope;
mod substitution;
mod supervise;

pub use plan::{Argument, Output, ParameterFile, Plan, Process, Respawn};
pub use report::{Report, Severity};
pub use resolve::{Request, arguments, resolve};
pub use supervise::{Alarm, Options, Outcome, Reporter, SuperviseError, supervise};
