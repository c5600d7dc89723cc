//! Files in memory: what is small, written often, and outlives processes only.

use std::env;
use std::path::{Path, PathBuf};

/// Where files are in memory, on Linux. On a disk a file that is replaced may hold up the event loop for a tenth of a second, and the
/// services of a node with four robots, each flushed to it, its start for two thirds of one.
pub(crate) const MEMORY: &str = "/dev/shm";

/// The user's folder there, since the place is everybody's; where there is none, with the temporary files.
pub(crate) fn users_folder() -> PathBuf {
    let folder = if Path::new(MEMORY).is_dir() { PathBuf::from(MEMORY) } else { env::temp_dir() };
    folder.join(format!("trench-{}", rustix::process::getuid().as_raw()))
}
