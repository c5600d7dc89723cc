//! Where the files of shared memory are.

use crate::memory::{MEMORY, users_folder};
use std::path::{Path, PathBuf};
use std::{fs, io};

/// What the names of all files begin with. One host's users do not meet.
pub(super) fn file_prefix(prefix: &str) -> String {
    format!("trench_{}_{prefix}_", rustix::process::getuid().as_raw())
}

/// The folder of services and nodes.
pub(super) fn folder(prefix: &str) -> PathBuf {
    users_folder().join(format!("shared_memory{prefix}"))
}

/// Removes what processes with this `TRENCH_SHM_PREFIX` left, once all of them have ended. What dead processes left is
/// cleaned up by the next one of their prefix; this is for prefixes that nobody uses again, as those of tests.
///
/// # Errors
/// When a file cannot be removed.
pub fn forget_shared_memory(prefix: &str) -> io::Result<()> {
    let ours = file_prefix(prefix);
    for entry in fs::read_dir(MEMORY)? {
        let entry = entry?;
        if entry.file_name().to_string_lossy().starts_with(&ours) {
            or_gone(fs::remove_file(entry.path()))?;
        }
    }
    or_gone(fs::remove_dir_all(folder(prefix)))?;
    // The folder of all prefixes goes with the last of them.
    let _others_live = folder(prefix).parent().map(Path::to_owned).map(fs::remove_dir);
    Ok(())
}

fn or_gone(result: io::Result<()>) -> io::Result<()> {
    result.or_else(|error| if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) })
}
