//! Going by another host's clock: how far it is away, measured.

mod estimate;

pub(crate) use estimate::{Estimate, Exchange, Offset};
