//! What a node says of itself on /diagnostics: once a second, at once when a level changes, and soon when what is wrong does.

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
    /// Something else is wrong than was said.
    news: bool,
    last_sent: Option<Steady>,
}

/// s, between two messages of which the second only says something else of the same condition: texts can have numbers in
/// them that change all the time.
const NEWS: f64 = 0.25;

impl Health {
    /// For the node with this fully qualified name.
    #[must_use]
    pub fn new(node: impl Into<String>) -> Self {
        Self { node: node.into(), entries: BTreeMap::new(), changed: false, news: false, last_sent: None }
    }

    /// Says how `part` is. A change of condition is sent with the next [`Health::publish`] at once, another reason for the
    /// same one within a quarter of a second.
    pub fn set(&mut self, part: &'static str, condition: Condition, message: impl Into<String>) {
        let message = message.into();
        let entry = self.entries.entry(part).or_default();
        self.changed |= entry.condition != condition;
        self.news |= condition != Condition::Ok && entry.message != message;
        entry.condition = condition;
        entry.message = message;
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
        let period = if self.news { NEWS } else { 1.0 };
        let due = self.last_sent.is_none_or(|last| at.steady.seconds_since(last) >= period);
        if !(due || self.changed) {
            return;
        }
        (self.changed, self.news) = (false, false);
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

#[cfg(test)]
mod tests {
    use super::{Condition, Health};
    use crate::{Outbox, RosTime, Steady, Times};

    #[test]
    fn changes_are_told_at_once_and_other_reasons_soon() {
        let mut health = Health::new("/node");
        // Milliseconds, condition, message, and whether it is told then.
        for (ms, condition, message, told) in [
            (0, Condition::Ok, "fine", true),
            (10, Condition::Ok, "fine", false),
            (20, Condition::Ok, "quite fine", false),
            (30, Condition::Warn, "a is late", true),
            (40, Condition::Warn, "b is late", false),
            (270, Condition::Warn, "b is late", false),
            (280, Condition::Warn, "b is late", true),
            (900, Condition::Warn, "b is late", false),
            (1280, Condition::Warn, "b is late", true),
            (1290, Condition::Ok, "fine", true),
        ] {
            let mut outbox = Outbox::default();
            health.set("part", condition, message);
            let now: u64 = ms * 1_000_000;
            health.publish(Times { ros: RosTime(now as i64), steady: Steady(now) }, 0, &mut outbox);
            assert_eq!(!outbox.actions.is_empty(), told, "{ms} ms: {message}");
        }
    }
}
