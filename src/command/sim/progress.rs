//! How far a simulation is, for who watches.

use std::fmt::Display;
use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

/// Between two lines.
const INTERVAL: Duration = Duration::from_millis(200);

/// A line at the bottom of the terminal; nothing where standard error is none.
pub(super) struct Progress {
    /// When to say the next; never where nobody watches.
    next: Option<Instant>,
    is_there: bool,
}

impl Progress {
    /// Says something if that is `wanted` and standard error is a terminal.
    pub(super) fn new(wanted: bool) -> Self {
        let shows = wanted && std::io::stderr().is_terminal();
        Self { next: shows.then(|| Instant::now() + INTERVAL), is_there: false }
    }

    /// Says how far it is, if it is time to.
    pub(super) fn at<T: Display>(&mut self, text: impl FnOnce() -> T) {
        let Some(next) = &mut self.next else { return };
        let now = Instant::now();
        if now >= *next {
            *next = now + INTERVAL;
            self.is_there = true;
            // A closed console is no reason to fail a run.
            let _ = write!(std::io::stderr(), "\r\x1b[K{}", text());
        }
    }

    /// Makes room for something else.
    pub(super) fn clear(&mut self) {
        if std::mem::take(&mut self.is_there) {
            let _ = write!(std::io::stderr(), "\r\x1b[K");
        }
    }
}
