//! From a frame's team state to what was made of it: messages that carry the same stamp.

use super::Spread;
use serde::Serialize;
use std::collections::BTreeMap;

/// What all begins with.
const SOURCE: &str = "/team_state";
/// How many frames back an answer may belong to.
const REMEMBERED: usize = 256;

/// How long after the team state the messages of a topic came that carry its stamp.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Latency {
    /// The team state's topic.
    pub from: String,
    /// The topic of what was made of it.
    pub to: String,
    /// How many messages belong to a team state of the bag.
    pub count: usize,
    /// From receipt to receipt at the recorder, s.
    pub seconds: Spread,
}

/// Pairs messages as they come.
#[derive(Default)]
pub(super) struct Latencies {
    /// When the team state of a stamp (ns) was logged, ns.
    frames: BTreeMap<i64, u64>,
    of: BTreeMap<String, Vec<f64>>,
}

impl Latencies {
    pub(super) fn note(&mut self, topic: &str, log_time: u64, stamp: Option<i64>) {
        let Some(stamp) = stamp else { return };
        if topic == SOURCE {
            self.frames.insert(stamp, log_time);
            if self.frames.len() > REMEMBERED {
                self.frames.pop_first();
            }
            return;
        }
        let Some(&seen) = self.frames.get(&stamp) else { return };
        let seconds = log_time.saturating_sub(seen) as f64 * 1e-9;
        match self.of.get_mut(topic) {
            Some(all) => all.push(seconds),
            None => drop(self.of.insert(topic.to_owned(), vec![seconds])),
        }
    }

    pub(super) fn finish(self) -> Vec<Latency> {
        let latency = |(to, values): (String, Vec<f64>)| {
            let count = values.len();
            Some(Latency { from: SOURCE.to_owned(), to, count, seconds: Spread::of(values)? })
        };
        self.of.into_iter().filter_map(latency).collect()
    }
}
