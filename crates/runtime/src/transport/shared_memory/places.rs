//! Where the files of shared memory are.

use crate::memory::{MEMORY, folder_in_memory};
use std::borrow::Cow;
use std::path::PathBuf;
use std::{fs, io};
use xxhash_rust::xxh3::xxh3_64;

/// Bytes of a `TRENCH_SHM_PREFIX` that names begin with as it is. The folder has it, and again each socket in the folder through
/// which readers are woken: an address of a socket has 107 bytes at most, of which iceoryx2's number takes up to 36.
const LONGEST_PREFIX: usize = 12;

/// What the names of all files begin with, the folder's too. One host's users do not meet.
pub(super) fn file_prefix(prefix: &str) -> String {
    let prefix = match prefix.len() {
        ..=LONGEST_PREFIX => Cow::Borrowed(prefix),
        _ => Cow::Owned(format!("{:08x}", xxh3_64(prefix.as_bytes()) as u32)),
    };
    format!("trench_{}_{prefix}_", rustix::process::getuid().as_raw())
}

/// The folder of services, nodes and sockets.
pub(super) fn folder(prefix: &str) -> PathBuf {
    folder_in_memory().join(file_prefix(prefix) + "dir")
}

/// Removes what processes with this `TRENCH_SHM_PREFIX` left, once all of them have ended. What dead processes left is
/// cleaned up by the next one of their prefix; this is for prefixes that nobody uses again, as those of tests.
///
/// # Errors
/// When a file cannot be removed.
pub fn forget_shared_memory(prefix: &str) -> io::Result<()> {
    let ours = file_prefix(prefix);
    or_gone(fs::remove_dir_all(folder(prefix)))?;
    for entry in fs::read_dir(MEMORY)? {
        let entry = entry?;
        if entry.file_name().to_string_lossy().starts_with(&ours) {
            or_gone(fs::remove_file(entry.path()))?;
        }
    }
    Ok(())
}

fn or_gone(result: io::Result<()>) -> io::Result<()> {
    result.or_else(|error| if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) })
}

#[cfg(test)]
mod tests {
    use super::{LONGEST_PREFIX, file_prefix, folder};

    /// `<folder>/<prefix><number>.event`, of users with numbers of five digits too.
    #[test]
    fn sockets_have_addresses_that_fit() {
        let uid = rustix::process::getuid().as_raw().to_string().len();
        for prefix in ["", "replay96_", &"x".repeat(LONGEST_PREFIX), &"x".repeat(LONGEST_PREFIX + 1), &"x".repeat(200)]
        {
            let longest = folder(prefix).as_os_str().len() + 1 + file_prefix(prefix).len() + 36 + ".event".len();
            assert!(longest + 2 * (5 - uid) <= 107, "{prefix}: {longest}");
        }
        assert_ne!(file_prefix(&"x".repeat(20)), file_prefix(&"x".repeat(21)));
    }
}
