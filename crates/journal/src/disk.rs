//! The files of this machine, for cores made in a process or in lock-step.

use std::fs::File;
use std::io::Read;
use std::os::unix::fs::PermissionsExt;
use trench_config::{ConfigError, Origin};
use trench_core::Files;

/// The file system.
#[derive(Debug, Clone, Copy)]
pub struct Disk;

/// The bits of a file's mode that let its group and all others in.
const OTHERS: u32 = 0o077;

impl Files for Disk {
    fn read(&self, key: &str, path: &str) -> Result<String, ConfigError> {
        std::fs::read_to_string(path).map_err(|error| unreadable(key, path, &error))
    }

    fn read_secret(&self, key: &str, path: &str) -> Result<String, ConfigError> {
        let mut text = String::new();
        // The mode is that of the file which is read, whatever its name stands for a moment later.
        let mut file = File::open(path).map_err(|error| unreadable(key, path, &error))?;
        let mode = file.metadata().map_err(|error| unreadable(key, path, &error))?.permissions().mode() & 0o7777;
        if mode & OTHERS != 0 {
            return Err(ConfigError {
                origin: Origin::new(path, 0),
                key: key.to_owned(),
                value: path.to_owned(),
                problem: format!("is secret, and its mode {mode:04o} lets others have it"),
                remedy: format!("chmod 600 {path}"),
            });
        }
        file.read_to_string(&mut text).map_err(|error| unreadable(key, path, &error))?;
        Ok(text)
    }
}

fn unreadable(key: &str, path: &str, error: &std::io::Error) -> ConfigError {
    ConfigError {
        origin: Origin::new(path, 0),
        key: key.to_owned(),
        value: path.to_owned(),
        problem: format!("cannot be read: {error}"),
        remedy: "name a file that exists and is text".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a file with this mode is read as.
    fn read(mode: u32) -> Result<String, ConfigError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("key");
        std::fs::write(&path, "000102").unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(mode)).unwrap();
        let told = Disk.read_secret("key_file", path.to_str().unwrap());
        assert_eq!(Disk.read("key_file", path.to_str().unwrap()).unwrap(), "000102");
        told.inspect_err(|error| assert_eq!(error.remedy, format!("chmod 600 {}", path.display())))
    }

    #[test]
    fn a_secret_is_for_its_owner_alone() {
        for mode in [0o600, 0o400, 0o700] {
            assert_eq!(read(mode).unwrap(), "000102", "{mode:o}");
        }
        for mode in [0o644, 0o640, 0o620, 0o604, 0o602, 0o601, 0o666, 0o777] {
            let error = read(mode).unwrap_err();
            assert_eq!(error.problem, format!("is secret, and its mode {mode:04o} lets others have it"));
            assert_eq!((error.key.as_str(), error.origin.line), ("key_file", 0));
        }
    }
}
