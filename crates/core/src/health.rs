//! What a node says of itself on /diagnostics: once a second, and at once when a level changes.

use crate::{Sink, Steady, Times};
use std::collections::BTreeMap;
use trench_msgs::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus, KeyValue};
use trench_msgs::std_msgs::Header;

/// How bad a thing is, with diagnostic_msgs/DiagnosticStatus's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
#[repr(u8)]
pub enum Condition {
    /// As it should be.
    #[default]
    Ok = 0,
    /// Worth a look.
    Warn = 1,
    /// A function is lost.
    Error = 2,
    /// Expected news stays away.
    Stale = 3,
}

#[derive(Debug, Clone, Default)]
struct Entry {
    condition: Condition,
    message: String,
    values: BTreeMap<&'static str, String>,
}

/// The named conditions and counters of one node.
#[derive(Debug, Clone)]
pub struct Health {
    node: String,
    entries: BTreeMap<&'static str, Entry>,
    changed: bool,
    last_sent: Option<Steady>,
}

impl Health {
    /// For the node with this fully qualified name.
    #[must_use]
    pub fn new(node: impl Into<String>) -> Self {
        Self { node: node.into(), entries: BTreeMap::new(), changed: false, last_sent: None }
    }

    /// Says how `part` is. A change of condition is sent with the next [`Health::publish`] at once.
    pub fn set(&mut self, part: &'static str, condition: Condition, message: impl Into<String>) {
        let entry = self.entries.entry(part).or_default();
        self.changed |= entry.condition != condition;
        entry.condition = condition;
        entry.message = message.into();
    }

    /// Gives a value of `part`, sent with its condition.
    pub fn value(&mut self, part: &'static str, key: &'static str, value: impl ToString) {
        self.entries.entry(part).or_default().values.insert(key, value.to_string());
    }

    /// The worst condition of all parts.
    #[must_use]
    pub fn worst(&self) -> Condition {
        self.entries.values().map(|entry| entry.condition).max().unwrap_or_default()
    }

    /// Publishes all parts if one changed or a second has passed.
    pub fn publish(&mut self, at: Times, port: usize, sink: &mut dyn Sink) {
        let due = self.last_sent.is_none_or(|last| at.steady.seconds_since(last) >= 1.0);
        if !(due || self.changed) {
            return;
        }
        self.changed = false;
        self.last_sent = Some(at.steady);
        sink.publish(port, &self.message(at));
    }

    fn message(&self, at: Times) -> DiagnosticArray {
        let status = self.entries.iter().map(|(part, entry)| DiagnosticStatus {
            level: entry.condition as u8,
            name: format!("{}: {part}", self.node),
            message: entry.message.clone(),
            hardware_id: self.node.clone(),
            values: entry
                .values
                .iter()
                .map(|(key, value)| KeyValue { key: (*key).to_owned(), value: value.clone() })
                .collect(),
        });
        DiagnosticArray { header: Header { stamp: at.ros.into(), frame_id: String::new() }, status: status.collect() }
    }
}
