//! Who does the shares of a step: this crate starts no threads, its callers may.

use std::fmt::Debug;

/// A share of a step's work. Shares know nothing of one another.
pub type Share<'a> = Box<dyn FnOnce() + Send + 'a>;

/// Does shares in any order, or several at once; all are done when it returns.
pub trait Workers: Debug {
    /// Into how many shares work is worth being divided.
    fn count(&self) -> usize;

    /// Does them.
    fn run(&self, shares: Vec<Share<'_>>);
}

/// One after the other.
#[derive(Debug, Clone, Copy, Default)]
pub struct Alone;

impl Workers for Alone {
    fn count(&self) -> usize {
        1
    }

    fn run(&self, shares: Vec<Share<'_>>) {
        shares.into_iter().for_each(|share| share());
    }
}
