//! What somebody writes to the process's standard input.

use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
use std::io;
use std::os::fd::{AsFd, OwnedFd};

/// As errors name it.
pub(super) const NAME: &str = "standard input";

/// A descriptor of its own, which reading does not block. Whoever writes is not concerned: the ends of a pipe are set apart.
pub(super) fn open() -> io::Result<OwnedFd> {
    let descriptor = io::stdin().as_fd().try_clone_to_owned()?;
    fcntl_setfl(&descriptor, fcntl_getfl(&descriptor)? | OFlags::NONBLOCK)?;
    Ok(descriptor)
}
