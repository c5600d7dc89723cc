//! The files of this machine, for cores made in a process or in lock-step.

use trench_config::{ConfigError, Origin};
use trench_core::Files;

/// The file system.
#[derive(Debug, Clone, Copy)]
pub struct Disk;

impl Files for Disk {
    fn read(&self, key: &str, path: &str) -> Result<String, ConfigError> {
        std::fs::read_to_string(path).map_err(|error| ConfigError {
            origin: Origin::new(path, 0),
            key: key.to_owned(),
            value: path.to_owned(),
            problem: format!("cannot be read: {error}"),
            remedy: "name a file that exists and is text".to_owned(),
        })
    }
}
