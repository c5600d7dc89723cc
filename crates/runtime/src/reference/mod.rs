//! Going by another host's clock: how far it is away, measured.

mod estimate;
mod questions;

pub(crate) use estimate::{Estimate, Exchange, Offset};
pub(crate) use questions::Questions;
