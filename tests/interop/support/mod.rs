//! Real processes of both sides for the interop tests: our stack under `trench launch`, and rclpy programs.

pub(crate) mod graph;
mod island;
mod launch;
pub(crate) mod markers;
#[path = "../../support/own_memory.rs"]
mod own_memory;
mod peer;
#[path = "../../support/programs.rs"]
mod programs;
#[path = "../../support/running.rs"]
mod running;
mod team;

pub(crate) use island::Island;
pub(crate) use launch::Launch;
pub(crate) use peer::{Follower, Publisher};
pub(crate) use running::Running;
pub(crate) use team::{Moment, number, stamp};

use std::time::Duration;

/// How long a condition may take to come true on a busy machine before a test fails.
pub(crate) const PATIENCE: Duration = Duration::from_secs(40);
