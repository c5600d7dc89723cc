//! How a process, the simulator and the bag checker make a node.

use crate::{NodeContext, NodeCore, StartError};
use trench_config::{ConfigError, ParameterDescriptor, Parameters};

/// Gives cores the text of the files their parameters name, so that they need no file system.
pub trait Files {
    /// The text of `path`.
    ///
    /// # Errors
    /// When it cannot be read; `key` (the parameter that names it) goes into the error.
    fn read(&self, key: &str, path: &str) -> Result<String, ConfigError>;

    /// The text of `path`, a secret: where it lies on a disk, nobody but its owner may be able to read or write it, and no
    /// journal keeps it.
    ///
    /// # Errors
    /// As [`Files::read`], and when others have access to it.
    fn read_secret(&self, key: &str, path: &str) -> Result<String, ConfigError> {
        self.read(key, path)
    }
}

/// Makes a core from its context, its parameters and the files they name.
pub type Build = fn(&NodeContext, &Parameters, &dyn Files) -> Result<Box<dyn NodeCore>, StartError>;

/// A kind of node.
#[derive(Debug, Clone, Copy)]
pub struct NodeDescription {
    /// The default node name, also that of the executable.
    pub name: &'static str,
    /// One sentence for `--help`.
    pub about: &'static str,
    /// What it declares.
    pub parameters: fn() -> Vec<ParameterDescriptor>,
    /// Makes the core.
    pub build: Build,
}
