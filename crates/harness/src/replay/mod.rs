//! Feeding a journal to the core that it is of, made anew, and comparing what the core does with what it did.

mod compare;
mod difference;
mod rerun;
mod subject;
mod text;

pub use difference::{Change, Changes, Difference, Pair};
pub use rerun::{ReplayError, Report, Verdict, move_over, replay, replay_from, update};
