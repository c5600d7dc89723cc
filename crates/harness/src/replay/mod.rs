//! Feeding a journal to the core that it is of, made anew, and comparing what the core does with what it did.

mod compare;
mod difference;
mod report;
mod rerun;
mod subject;
mod text;
mod tolerance;
mod trace;
mod update;

pub use difference::{Change, Changes, Difference, Pair};
pub use report::{ReplayError, Report, Verdict};
pub use rerun::{replay, replay_from, replay_within};
pub use tolerance::Tolerances;
pub use trace::{Sample, Trace, trace};
pub use update::{move_over, update};
