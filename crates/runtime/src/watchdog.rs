//! Ends a process that the network holds fast.
//!
//! Opening endpoints and leaving go through threads of the network's library, which no signal reaches. `transport/dds/pause.rs`
//! keeps from the one lock-up of RustDDS that is known. A process that ends can be started again, whatever held it.

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
