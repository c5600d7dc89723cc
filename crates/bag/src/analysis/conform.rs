//! When robots came to their segments (Definition 2.1.1), as they tell by themselves.

use serde::Serialize;
use std::collections::BTreeMap;
use trench_core::RosTime;
use trench_msgs::Message;
use trench_msgs::msg::LeaderState;

/// How one robot conformed to its segment.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Conformance {
    /// The robot.
    pub robot: String,
    /// When it was first within the queue's tolerance, s.
    pub first: Option<f64>,
    /// Since when it was so to the end, s: its time to conform.
    pub for_good: Option<f64>,
    /// Its distance from the segment at the end, m.
    pub final_distance: f64,
}

/// Follows leader states in log order.
#[derive(Default)]
pub(super) struct Conformances {
    robots: BTreeMap<String, Conformance>,
}

impl Conformances {
    pub(super) fn take(&mut self, cdr: &[u8], t0: i64) {
        let Ok(state) = LeaderState::decode(cdr) else { return };
        let time = RosTime::from(&state.header.stamp).seconds_since(RosTime(t0));
        if time < 0.0 {
            return; // The run has not begun.
        }
        let none =
            |robot: &String| Conformance { robot: robot.clone(), first: None, for_good: None, final_distance: 0.0 };
        let robot = self.robots.entry(state.robot.clone()).or_insert_with_key(none);
        robot.final_distance = state.segment_distance;
        if state.conforms {
            robot.first.get_or_insert(time);
            robot.for_good.get_or_insert(time);
        } else {
            robot.for_good = None;
        }
    }

    pub(super) fn finish(self) -> Vec<Conformance> {
        self.robots.into_values().collect()
    }
}
