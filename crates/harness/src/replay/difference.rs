//! What differs, and by how much.

use std::collections::BTreeMap;
use std::fmt;
use trench_core::RosTime;

/// Two values where one was expected.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// The field of a message, for example `twist.linear.x`; empty where the whole differs.
    pub path: String,
    /// What the journal says.
    pub recorded: String,
    /// What the core does now.
    pub now: String,
    /// By how much a number differs.
    pub by: Option<f64>,
}

/// The first output that is not as recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// The node's full name.
    pub node: String,
    /// Since the first event, s.
    pub seconds: f64,
    /// ROS time of the event.
    pub ros: RosTime,
    /// The topic, service or stream, or another output.
    pub subject: String,
    /// The first field that differs.
    pub pair: Pair,
    /// Outputs that were equal before.
    pub equal_before: u64,
}

impl fmt::Display for Difference {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { node, seconds, ros, subject, pair, equal_before } = self;
        let (whole, part) = (ros.0.div_euclid(1_000_000_000), ros.0.rem_euclid(1_000_000_000));
        let separator = if pair.path.is_empty() { "" } else { ": " };
        write!(
            out,
            "{node}: {subject} at t = {seconds:.3} s (ROS time {whole}.{part:09}): {}{separator}recorded {}, now {} \
             ({equal_before} outputs equal before)",
            pair.path, pair.recorded, pair.now
        )
    }
}

/// What differs in all.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Changes {
    /// By topic, service, stream or other output.
    pub subjects: BTreeMap<String, Change>,
}

/// How one topic, service, stream or other output differs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Change {
    /// How many outputs do.
    pub count: u64,
    /// The largest difference among the first differing fields, with its path.
    pub largest: Option<(String, f64)>,
}

impl Changes {
    pub(super) fn add(&mut self, subject: &str, pair: &Pair) {
        let change = self.subjects.entry(subject.to_owned()).or_default();
        change.count += 1;
        if let Some(by) = pair.by
            && change.largest.as_ref().is_none_or(|(_, largest)| by > *largest)
        {
            change.largest = Some((pair.path.clone(), by));
        }
    }
}

impl fmt::Display for Change {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{} outputs differ", self.count)?;
        match &self.largest {
            Some((path, by)) => write!(out, ", {path} by up to {by:.3e}"),
            None => Ok(()),
        }
    }
}
