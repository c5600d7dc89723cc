//! Topics that a core wants to read since somebody writes them.

use crate::process::Process;
use trench_core::{Discovered, Steady, Subscribe};

/// s, between two looks whether the network is prepared.
const LOOK: f64 = 0.005;
/// s, after which subscriptions are opened without.
const PATIENCE: f64 = 2.0;

/// What is to be opened as soon as the network is prepared for it.
#[derive(Default)]
pub(crate) struct Found {
    /// Each with the number of its node.
    wanted: Vec<(usize, Subscribe)>,
    /// The first of them.
    since: Option<Steady>,
}

impl Found {
    /// When to look again.
    pub(crate) fn next_look(&self, now: Steady) -> Option<Steady> {
        self.since.map(|_| now.plus_seconds(LOOK))
    }
}

impl Process {
    /// Shows the nodes a topic that somebody writes.
    pub(crate) fn discover(&mut self, topic: Discovered<'_>, now: Steady) {
        for (index, node) in self.nodes.iter_mut().enumerate() {
            if let Some(subscribe) = node.wants(topic) {
                self.found.wanted.push((index, subscribe));
                self.found.since.get_or_insert(now);
                self.network.prepare_to_open();
            }
        }
    }

    /// Opens what was found, once the network is prepared.
    pub(crate) fn open_found(&mut self, now: Steady) {
        let late = self.found.since.is_some_and(|since| now.seconds_since(since) > PATIENCE);
        if self.found.wanted.is_empty() || !(late || self.network.is_prepared()) {
            return;
        }
        let found = std::mem::take(&mut self.found);
        let mut nodes = std::mem::take(&mut self.nodes);
        for (index, subscribe) in found.wanted {
            let Some(node) = nodes.get_mut(index) else { continue };
            if let Err(error) = node.open_found(&subscribe, index, &mut self.connections()) {
                node.warn(&error.to_string());
            }
        }
        self.nodes = nodes;
        if let Err(error) = self.network.announce() {
            self.nodes.iter_mut().for_each(|node| node.warn(&error.to_string()));
        }
    }
}
