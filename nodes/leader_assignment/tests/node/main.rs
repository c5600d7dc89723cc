//! The node as its neighbours see it: services, goals, run state, and what outlives it.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod bench;
mod formations;
mod members;
mod runs;
mod targets;
