//! One process a node and domain on a host: two that do the same would work against each other.

use rustix::fs::{FlockOperation, flock};
use std::fs::{self, File, OpenOptions};
use std::path::Path;

/// Held for as long as the process lives; the kernel takes it back however the process ends.
#[derive(Debug)]
pub(crate) struct Lease {
    /// Kept open, which is what holds the lock.
    _file: Option<File>,
}

/// Somebody else holds it.
#[derive(Debug, thiserror::Error)]
#[error("another process on this host is {node} in domain {domain} already; stop that one first")]
pub(crate) struct Taken {
    node: String,
    domain: u16,
}

impl Lease {
    /// Takes the lease of `node`, whose lock is the file `path`. Where no file can be made there is none to take.
    pub(crate) fn take(path: &Path, node: &str, domain: u16) -> Result<Self, Taken> {
        let open = || {
            fs::create_dir_all(path.parent().unwrap_or(Path::new(".")))?;
            OpenOptions::new().create(true).truncate(false).write(true).open(path)
        };
        let file: Option<File> = match open() {
            Ok(file) => Some(file),
            Err(error) => {
                eprintln!("{node}: nothing keeps a second {node} away: {}: {error}", path.display());
                None
            }
        };
        match &file {
            Some(file) if flock(file, FlockOperation::NonBlockingLockExclusive).is_err() => {
                Err(Taken { node: node.to_owned(), domain })
            }
            _ => Ok(Self { _file: file }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_is_refused_until_the_first_has_ended() {
        let folder = std::env::temp_dir().join(format!("trench-lease-{}", std::process::id()));
        let path = folder.join("node.lock");
        let first = Lease::take(&path, "/node", 7).unwrap();
        let refused = Lease::take(&path, "/node", 7).unwrap_err().to_string();
        assert!(refused.contains("/node in domain 7"), "{refused}");
        drop(first);
        drop(Lease::take(&path, "/node", 7).unwrap());
        fs::remove_dir_all(folder).unwrap();
    }
}
