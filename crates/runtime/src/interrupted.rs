//! Waiting goes on where a stop interrupted it.
//!
//! Who is stopped and goes on (SIGSTOP and SIGCONT, a debugger that looks in) finds its `epoll_wait` interrupted, without any handler
//! (signal(7), "Interruption of system calls and library functions by stop signals"). RustDDS 0.15.1 takes that for the end: its thread
//! of the network (`DPEventLoop::event_loop`) and its discovery (`Discovery::discovery_event_loop`) return on any error of `poll`. The
//! process then lives on, deaf and mute to all that it does not share memory with. Seen: a leader_assignment that was stopped for
//! 3 s said no goals to robots on other hosts from then on.
//!
//! So this process has an `epoll_wait` of its own, which is never interrupted; the linker takes it before the C library's. Signals are
//! events of what is waited for ([`crate::signals`]): nobody waits for the interruption. A release of RustDDS that goes on by itself makes
//! this file superfluous.

use std::ffi::{c_int, c_void};
use std::io::{Error, ErrorKind};
use std::ptr;
use std::time::{Duration, Instant};

#[expect(unsafe_code, reason = "the C library's own function")]
unsafe extern "C" {
    fn epoll_pwait(epoll: c_int, events: *mut c_void, most: c_int, timeout: c_int, mask: *const c_void) -> c_int;
}

/// epoll_wait(2), without EINTR.
///
/// # Safety
/// As of the C library's: there is room for `most` events.
#[expect(unsafe_code, reason = "the C library's `epoll_wait` is replaced, by its own interface")]
#[unsafe(no_mangle)]
unsafe extern "C" fn epoll_wait(epoll: c_int, events: *mut c_void, most: c_int, timeout: c_int) -> c_int {
    let patience = u64::try_from(timeout).ok().map(Duration::from_millis);
    let start = Instant::now();
    let mut left = timeout;
    loop {
        // SAFETY: what the caller promises; without a mask it is `epoll_wait`.
        let ready = unsafe { epoll_pwait(epoll, events, most, left, ptr::null()) };
        if ready >= 0 || Error::last_os_error().kind() != ErrorKind::Interrupted {
            return ready;
        }
        if let Some(patience) = patience {
            left = c_int::try_from(patience.saturating_sub(start.elapsed()).as_millis()).unwrap_or(0);
        }
    }
}
