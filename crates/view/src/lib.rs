//! The live picture: from the stream of messages, live or of a bag, to what the page in the browser draws.
//!
//! | what | where |
//! |---|---|
//! | which topics there are, and what they are to the picture | [`Role`] |
//! | the state of the picture, message by message | [`View`] |
//! | what changed since a browser last asked, as JSON | [`Snapshot`], [`Seen`] |
//! | what of it goes out as markers | `shown` |
//! | the last minute, for browsers that come late and for jumps in a bag | `history` |
//! | a bag in memory, and one browser's way through it | [`Recording`], [`Player`] |
//! | what the page of colours asks for | [`colours`] |
//! | the pages themselves: HTML, style, scripts, all inside the program | [`page`] |
//!
//! Nothing here waits, reads a clock or knows a socket: `trench view` does.

mod alarms;
pub mod colours;
mod control;
mod formation;
mod history;
mod markers;
mod obstacles;
pub mod page;
mod player;
mod recording;
mod role;
mod shown;
mod snapshot;
mod team;
mod view;

pub use player::{Command, Player};
pub use recording::{LoadError, Recording};
pub use role::{Role, subscriptions};
pub use snapshot::{Seen, Snapshot};
pub use view::View;

/// A length, an angle or a time as the page gets it: tenths of millimetres are enough for anyone's eyes. What is no
/// number becomes `null`.
fn short(value: f64) -> Option<f64> {
    value.is_finite().then(|| (value * 1e4).round() / 1e4)
}

/// A point as the page gets it, m.
fn point(x: f64, y: f64) -> [Option<f64>; 2] {
    [short(x), short(y)]
}

/// A point as the page gets it.
type Point = [Option<f64>; 2];

/// A stamp as the page gets it: seconds, to tenths of milliseconds.
fn seconds(time: trench_core::RosTime) -> f64 {
    (time.0 / 100_000) as f64 * 1e-4
}
