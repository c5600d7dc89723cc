//! Bags from the outside: written, read, damaged, and read by programs of others.
#![expect(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

mod analysis;
mod common;
mod damage;
mod peers;
mod player;
mod recorder;
mod round_trip;
mod runs;
mod split;
mod vouched;
