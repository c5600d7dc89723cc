//! Ends a process that the network holds fast.
//!
//! RustDDS 0.15.1 locks up now and then when many endpoints are found at once: its discovery thread waits for room in a
//! channel of 32 places while it holds the lock that the other thread needs to take anything out. Opening an endpoint or
//! leaving then takes for ever, and no signal is heard. A process that ends can be started again.

use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// Something that must be over in time.
pub(crate) struct Watchdog {
    /// The end of this is the end of the watch.
    _watched: Sender<()>,
}

impl Watchdog {
    /// Ends the process with `code`, saying `what` did not happen, unless it is dropped within `patience`.
    pub(crate) fn new(patience: Duration, code: u8, what: &'static str) -> Self {
        let (watched, over) = channel::<()>();
        std::thread::spawn(move || {
            if over.recv_timeout(patience) == Err(RecvTimeoutError::Timeout) {
                eprintln!("{what} within {} s", patience.as_secs());
                std::process::exit(code.into());
            }
        });
        Self { _watched: watched }
    }
}
