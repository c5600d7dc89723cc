//! State that outlives a process (architecture invariant 12): one small file a node, replaced as a whole.

use crate::memory::users_folder;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// Where a node keeps its checkpoint. Files survive the process, not necessarily the machine: a restart after a crash is
/// what they are for, so nothing is flushed to the disk.
#[derive(Debug, Clone)]
pub(crate) struct Checkpoint {
    path: PathBuf,
}

impl Checkpoint {
    /// For the node with this full name: in `$TRENCH_STATE_DIR`, else in `$XDG_RUNTIME_DIR/trench/<domain>`, else in a folder
    /// of the user's in memory ([`users_folder`]).
    pub(crate) fn of(node: &str, domain: u16) -> Self {
        let folder = state_folder(domain, |name| env::var_os(name));
        Self::inside(&folder, node)
    }

    fn inside(folder: &Path, node: &str) -> Self {
        Self { path: folder.join(format!("{}.checkpoint", node.trim_start_matches('/').replace('/', "."))) }
    }

    /// What the last life left, if anything.
    pub(crate) fn read(&self) -> io::Result<Option<Vec<u8>>> {
        match fs::read(&self.path) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Replaces it: a reader finds the old bytes or the new ones, never a mixture.
    pub(crate) fn write(&self, bytes: &[u8]) -> io::Result<()> {
        if let Some(folder) = self.path.parent() {
            fs::create_dir_all(folder)?;
        }
        let new = self.path.with_extension("checkpoint.new");
        fs::write(&new, bytes)?;
        fs::rename(&new, &self.path)
    }

    /// Of the lock that keeps a second process of this node away.
    pub(crate) fn lock_path(&self) -> PathBuf {
        self.path.with_extension("lock")
    }

    /// For messages.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }
}

fn state_folder(domain: u16, variable: impl Fn(&str) -> Option<OsString>) -> PathBuf {
    match (variable("TRENCH_STATE_DIR"), variable("XDG_RUNTIME_DIR")) {
        (Some(folder), _) => PathBuf::from(folder),
        (None, Some(runtime)) => Path::new(&runtime).join("trench").join(domain.to_string()),
        // Without a runtime folder: in a container, of a daemon.
        (None, None) => users_folder().join(domain.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_bytes_come_back() {
        let folder = env::temp_dir().join(format!("trench-checkpoint-{}", std::process::id()));
        let checkpoint = Checkpoint::inside(&folder, "/robot1/pilot");
        assert_eq!(checkpoint.read().unwrap(), None);
        checkpoint.write(b"one").unwrap();
        checkpoint.write(b"two").unwrap();
        assert_eq!(checkpoint.read().unwrap().unwrap(), b"two");
        assert_eq!(checkpoint.path().file_name().unwrap(), "robot1.pilot.checkpoint");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "nothing is left beside it");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn folders_by_environment() {
        let check = |set: &[(&str, &str)], expected: &str| {
            let variable = |name: &str| set.iter().find(|(key, _)| *key == name).map(|(_, value)| value.into());
            assert_eq!(state_folder(7, variable), Path::new(expected));
        };
        check(&[("TRENCH_STATE_DIR", "/a"), ("XDG_RUNTIME_DIR", "/b")], "/a");
        check(&[("XDG_RUNTIME_DIR", "/b")], "/b/trench/7");
        check(&[], users_folder().join("7").to_str().unwrap());
    }
}
