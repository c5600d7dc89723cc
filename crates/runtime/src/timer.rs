//! A timer that the event loop waits for: the kernel's, since poll time-outs count in milliseconds.

use crate::clock::steady_now;
use rustdds::mio1::unix::SourceFd;
use rustdds::mio1::{Interest, Registry, Token};
use rustix::time::{
    Itimerspec, TimerfdClockId, TimerfdFlags, TimerfdTimerFlags, Timespec, timerfd_create, timerfd_settime,
};
use std::io;
use std::os::fd::{AsRawFd, OwnedFd};
use std::time::Duration;
use trench_core::Steady;

/// Wakes the loop at one moment of the monotonic clock.
#[derive(Debug)]
pub(crate) struct Timer {
    descriptor: OwnedFd,
    armed: Option<Steady>,
}

impl Timer {
    /// Not armed.
    pub(crate) fn new() -> io::Result<Self> {
        let flags = TimerfdFlags::NONBLOCK | TimerfdFlags::CLOEXEC;
        Ok(Self { descriptor: timerfd_create(TimerfdClockId::Monotonic, flags)?, armed: None })
    }

    /// Adds it to the loop.
    pub(crate) fn register(&self, registry: &Registry, token: Token) -> io::Result<()> {
        registry.register(&mut SourceFd(&self.descriptor.as_raw_fd()), token, Interest::READABLE)
    }

    /// Arms it for `at`, or not at all. Gives how long the loop may wait for anything: what is due already is due without the
    /// kernel's help, which costs as much as a message.
    pub(crate) fn set(&mut self, at: Option<Steady>) -> io::Result<Option<Duration>> {
        if at.is_some_and(|at| at <= steady_now()) {
            return Ok(Some(Duration::ZERO));
        }
        if self.armed == at {
            return Ok(None);
        }
        // All zero means "never" to the kernel; what is to come is later than that.
        let nanoseconds = at.map_or(0, |at| at.0);
        let value = Timespec {
            tv_sec: i64::try_from(nanoseconds / 1_000_000_000).unwrap_or(i64::MAX),
            tv_nsec: (nanoseconds % 1_000_000_000) as i64,
        };
        let once = Itimerspec { it_interval: Timespec { tv_sec: 0, tv_nsec: 0 }, it_value: value };
        timerfd_settime(&self.descriptor, TimerfdTimerFlags::ABSTIME, &once)?;
        self.armed = at;
        Ok(None)
    }

    /// Acknowledges that it went off; the next [`Timer::set`] arms it anew.
    pub(crate) fn clear(&mut self) {
        let mut count = [0_u8; 8];
        // Only the reading matters: it makes the descriptor unreadable until the timer goes off again.
        let _expirations = rustix::io::read(&self.descriptor, &mut count);
        self.armed = None;
    }
}
