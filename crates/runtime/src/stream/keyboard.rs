//! Keys pressed in the terminal that the process was started from.

use rustix::fs::{Mode, OFlags};
use rustix::process::getpgrp;
use rustix::termios::{LocalModes, OptionalActions, Termios, tcgetattr, tcgetpgrp, tcsetattr};
use std::io;
use std::os::fd::OwnedFd;

/// The controlling terminal of whoever opens it.
pub(super) const TERMINAL: &str = "/dev/tty";

/// The terminal, and how it was set before: it gets its settings back in the end.
#[derive(Default)]
pub(super) struct Keyboard {
    before: Option<(OwnedFd, Termios)>,
}

impl Keyboard {
    /// Makes the terminal give each key at once, without echo. Keys that stop or end a process keep their effect.
    pub(super) fn open(&mut self) -> io::Result<OwnedFd> {
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
        let descriptor = rustix::fs::open(TERMINAL, flags, Mode::empty())?;
        // Setting the terminal from the background would stop the process.
        if tcgetpgrp(&descriptor)? != getpgrp() {
            return Err(io::Error::other("this process is in the background"));
        }
        let before = tcgetattr(&descriptor)?;
        let mut settings = before.clone();
        settings.local_modes.remove(LocalModes::ICANON | LocalModes::ECHO);
        tcsetattr(&descriptor, OptionalActions::Now, &settings)?;
        self.before = Some((descriptor.try_clone()?, before));
        Ok(descriptor)
    }
}

impl Drop for Keyboard {
    fn drop(&mut self) {
        if let Some((descriptor, before)) = &self.before {
            let _terminal_is_gone = tcsetattr(descriptor, OptionalActions::Now, before);
        }
    }
}
