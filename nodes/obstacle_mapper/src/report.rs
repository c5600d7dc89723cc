//! What the mapper tells people of its input.

use std::collections::BTreeSet;
use trench_core::{Condition, Health, Level, Sink};

/// Complaints are logged once each; different ones no more than these.
const MOST_KINDS: usize = 64;

/// One kind of input: how often it was refused, and why last.
pub(crate) struct Report {
    part: &'static str,
    refused: u64,
    said: BTreeSet<String>,
}

impl Report {
    /// For a part of /diagnostics.
    pub(crate) fn new(part: &'static str) -> Self {
        Self { part, refused: 0, said: BTreeSet::new() }
    }

    /// Something cannot be used as it is. The log hears of each reason once.
    pub(crate) fn refuse(&mut self, what: &str, health: &mut Health, sink: &mut dyn Sink) {
        self.refused += 1;
        health.set(self.part, Condition::Error, what);
        health.value(self.part, "refused", self.refused);
        if self.said.len() < MOST_KINDS && self.said.insert(what.to_owned()) {
            sink.log(Level::Warn, what);
        }
    }

    /// All is well at the moment.
    pub(crate) fn accept(&self, message: impl Into<String>, health: &mut Health) {
        health.set(self.part, Condition::Ok, message);
        if self.refused > 0 {
            health.value(self.part, "refused", self.refused);
        }
    }
}
