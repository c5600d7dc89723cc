//! The controller as its neighbours see it: messages in, messages out.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod bench;
mod chain;
mod deviation;
mod face;
mod laws;
mod markers;
mod remedies;
mod stability;
mod ticks;
mod turns;
