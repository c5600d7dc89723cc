//! Shared memory of a test's own.

/// A `TRENCH_SHM_PREFIX`. What processes leave that had it, and that have ended by then, goes with it: make it before them.
pub(crate) struct OwnMemory(pub(crate) String);

impl Drop for OwnMemory {
    fn drop(&mut self) {
        if let Err(error) = trench_runtime::forget_shared_memory(&self.0) {
            println!("shared memory of the test stays behind: {error}");
        }
    }
}
