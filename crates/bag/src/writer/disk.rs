//! How full the disk is.

use std::io;
use std::path::Path;

/// Bytes an ordinary user can still write to the file system that holds `path`.
pub(super) fn available(path: &Path) -> io::Result<u64> {
    let status = rustix::fs::statvfs(path)?;
    Ok(status.f_bavail.saturating_mul(status.f_frsize))
}
