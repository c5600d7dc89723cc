//! A serial device.

use rustix::fs::{FlockOperation, Mode, OFlags, flock};
use rustix::termios::{OptionalActions, QueueSelector, isatty, tcflush, tcgetattr, tcsetattr};
use std::io;
use std::os::fd::OwnedFd;

/// A device file that may vanish and come back.
pub(super) struct Serial {
    path: String,
    baud: u32,
}

impl Serial {
    pub(super) fn new(path: &str, baud: u32) -> Self {
        Self { path: path.to_owned(), baud }
    }

    pub(super) fn path(&self) -> &str {
        &self.path
    }

    /// Opens the device for this process alone: raw bytes, nothing in its buffers.
    pub(super) fn open(&self) -> io::Result<OwnedFd> {
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
        let descriptor = rustix::fs::open(&self.path, flags, Mode::empty())?;
        if !isatty(&descriptor) {
            return Err(io::Error::other("not a serial device; name one such as /dev/ttyUSB0"));
        }
        flock(&descriptor, FlockOperation::NonBlockingLockExclusive)
            .map_err(|_| io::Error::other("another process uses it; stop that one first"))?;
        let mut settings = tcgetattr(&descriptor)?;
        settings.make_raw();
        settings.set_speed(self.baud)?;
        tcsetattr(&descriptor, OptionalActions::Now, &settings)?;
        // Bytes of an earlier life would be read as if they were of now.
        tcflush(&descriptor, QueueSelector::IOFlush)?;
        Ok(descriptor)
    }
}
