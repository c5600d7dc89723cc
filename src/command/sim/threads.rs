//! Threads that step the robots of a chain.

use trench_formation::simulate::{Share, Workers};

/// As many as this says, the calling one among them.
#[derive(Debug)]
pub(super) struct Threads(pub(super) usize);

impl Workers for Threads {
    fn count(&self) -> usize {
        self.0
    }

    fn run(&self, mut shares: Vec<Share<'_>>) {
        let own = shares.pop();
        std::thread::scope(|scope| {
            for share in shares {
                scope.spawn(share);
            }
            if let Some(own) = own {
                own();
            }
        });
    }
}
