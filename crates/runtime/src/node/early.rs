//! What a writer of a latched topic said before this reader came.

use crate::transport::network::NetworkSample;
use std::collections::VecDeque;
use trench_core::Steady;

/// How long the first messages of a writer are gathered: they arrive together.
const GATHER_SECONDS: f64 = 0.01;

/// The first messages of writers not heard before. A DDS writer may send a late joiner more of its past than the depth
/// it offers (RustDDS trims it only every six seconds); of those, only the newest are for the node.
#[derive(Default)]
pub(super) struct Early {
    samples: VecDeque<NetworkSample>,
    until: Option<Steady>,
}

impl Early {
    /// Keeps a message, and of its writer no more than the newest `depth`.
    pub(super) fn keep(&mut self, sample: NetworkSample, depth: usize, now: Steady) {
        let gid = sample.source.gid;
        self.samples.push_back(sample);
        self.until.get_or_insert(now.plus_seconds(GATHER_SECONDS));
        let same = |kept: &NetworkSample| kept.source.gid == gid;
        if self.samples.iter().filter(|kept| same(kept)).count() > depth.max(1)
            && let Some(oldest) = self.samples.iter().position(same)
        {
            self.samples.remove(oldest);
        }
    }

    /// Whether anything of this writer is kept.
    pub(super) fn holds(&self, gid: &[u8; 16]) -> bool {
        self.samples.iter().any(|sample| sample.source.gid == *gid)
    }

    /// When what is kept should be released.
    pub(super) fn until(&self) -> Option<Steady> {
        self.until
    }

    /// Gives all that is kept.
    pub(super) fn release(&mut self) -> VecDeque<NetworkSample> {
        self.until = None;
        std::mem::take(&mut self.samples)
    }
}
