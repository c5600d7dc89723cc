//! From the robots' lasers to partial boundaries (Remark 7.4.1).

mod clusters;
mod intake;
mod memory;
mod walls;
mod watch;

pub(crate) use clusters::Clusters;
pub(crate) use intake::{Beams, check, locate};
pub(crate) use memory::Memory;
pub(crate) use watch::Watch;
