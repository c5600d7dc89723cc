//! Files in memory: what is small, written often, and outlives processes only.

use std::env;
use std::path::{Path, PathBuf};

/// Where files are in memory, on Linux. On a disk a file that is replaced may hold up the event loop for a tenth of a second, and the
/// services of a node with four robots, each flushed to it, its start for two thirds of one.
pub(crate) const MEMORY: &str = "/dev/shm";

/// That place; where there is none, the one of temporary files.
pub(crate) fn folder_in_memory() -> PathBuf {
    if Path::new(MEMORY).is_dir() { PathBuf::from(MEMORY) } else { env::temp_dir() }
}

/// The user's folder there, since the place is everybody's.
pub(crate) fn users_folder() -> PathBuf {
    folder_in_memory().join(format!("trench-{}", rustix::process::getuid().as_raw()))
}
