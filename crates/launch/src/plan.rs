//! What a launch file asks for, with everything resolved.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Duration;
use trench_config::{ConfigError, Origin};

/// The processes to run.
#[derive(Debug, Clone, Default)]
pub struct Plan {
    /// In the order of the file.
    pub processes: Vec<Process>,
    /// Things that are probably not meant, such as two nodes of one name.
    pub warnings: Vec<ConfigError>,
}

/// One process to run.
#[derive(Debug, Clone, PartialEq)]
pub struct Process {
    /// `name-N`, N counting from 1 in the order of the file: the prefix of its output.
    pub label: String,
    /// Whether it is a ROS node, which says by its exit code that it refuses its configuration.
    pub is_node: bool,
    /// Program and arguments. The program is a path or a name on PATH.
    pub argv: Vec<String>,
    /// Variables that differ from the launcher's own: their values, or `None` where they are unset.
    pub environment: BTreeMap<String, Option<String>>,
    /// The folder it runs in; the launcher's where none is given.
    pub folder: Option<PathBuf>,
    /// Parameter files to write before it starts; `argv` names them.
    pub parameter_files: Vec<ParameterFile>,
    /// How long after the start of the run it starts (timers).
    pub start_after: Duration,
    /// Where its standard output goes besides its log file.
    pub output: Output,
    /// Whether and how it is started again when it ends.
    pub respawn: Option<Respawn>,
    /// Whether its end ends the run (`on_exit: shutdown`); then its exit code is the run's.
    pub ends_run: bool,
    /// From SIGINT to SIGTERM.
    pub sigterm_timeout: Duration,
    /// From SIGTERM to SIGKILL.
    pub sigkill_timeout: Duration,
    /// Where the launch file asks for it.
    pub origin: Origin,
}

/// A parameter file that the launcher writes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParameterFile {
    /// Where.
    pub path: PathBuf,
    /// What.
    pub text: String,
}

/// Where a process's standard output goes besides its log file. Its standard error goes to the screen either way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Output {
    /// Nowhere.
    Log,
    /// To the screen.
    Screen,
}

/// How a process is started again when it ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Respawn {
    /// How long to wait first.
    pub delay: Duration,
    /// How often; as often as needed if `None`.
    pub max_retries: Option<u32>,
}

/// An argument that a launch file declares.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Argument {
    /// Its name.
    pub name: String,
    /// The value where none is given, as written; required if `None`.
    pub default: Option<String>,
    /// What it is for; may be empty.
    pub description: String,
    /// The only values allowed; any if empty.
    pub choices: Vec<String>,
}
