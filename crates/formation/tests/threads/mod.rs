//! Threads that do the shares of a step.

use trench_formation::simulate::{Share, Workers};

/// As many threads as this says.
#[derive(Debug)]
pub(crate) struct Threads(pub(crate) usize);

impl Workers for Threads {
    fn count(&self) -> usize {
        self.0
    }

    fn run(&self, shares: Vec<Share<'_>>) {
        std::thread::scope(|scope| {
            for share in shares {
                scope.spawn(share);
            }
        });
    }
}
