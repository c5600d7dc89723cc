//! What needs a person: states on /diagnostics that are not OK, and those that nobody renews.

use serde::Serialize;
use std::collections::BTreeMap;
use trench_core::RosTime;
use trench_msgs::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};

/// Nodes renew their states every second; after this long they are stale, s.
const STALE: f64 = 3.5;
/// How long one collision is shown, s.
const COLLISION: f64 = 5.0;
/// States that are remembered at most: a foreign node may invent names without end.
const MOST: usize = 2000;

#[derive(Debug, Clone, Default)]
pub(crate) struct Alarms {
    states: BTreeMap<String, Known>,
    collisions: Vec<(RosTime, String)>,
}

#[derive(Debug, Clone)]
struct Known {
    heard: RosTime,
    level: u8,
    message: String,
}

/// One line of the list.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Alarm<'a> {
    pub(crate) level: &'static str,
    pub(crate) name: &'a str,
    pub(crate) message: &'a str,
}

impl Alarms {
    /// Gives whether the list may have changed.
    pub(crate) fn take(&mut self, now: RosTime, array: DiagnosticArray) -> bool {
        let mut changed = false;
        for status in array.status {
            let known = Known { heard: now, level: status.level, message: status.message };
            let has_room = self.states.len() < MOST;
            match self.states.get_mut(&status.name) {
                Some(old) => {
                    changed |= old.level != known.level || (known.level != 0 && old.message != known.message);
                    *old = known;
                }
                None if has_room => {
                    changed |= known.level != 0;
                    self.states.insert(status.name, known);
                }
                None => {}
            }
        }
        changed
    }

    pub(crate) fn collided(&mut self, now: RosTime, array: &DiagnosticArray) {
        let told = array.status.iter().map(|status| (now, format!("{}: {}", status.name, status.message)));
        self.collisions.extend(told);
        let from = self.collisions.len().saturating_sub(MOST);
        self.collisions.drain(..from);
    }

    /// The worst first.
    pub(crate) fn list(&self, now: RosTime) -> Vec<Alarm<'_>> {
        let collisions = self.collisions.iter().filter(|(at, _)| now.seconds_since(*at) < COLLISION);
        let collisions = collisions.map(|(_, text)| Alarm { level: "error", name: "collision", message: text });
        let states = self.states.iter().filter_map(|(name, known)| {
            let level = match known.level {
                _ if now.seconds_since(known.heard) > STALE => "stale",
                DiagnosticStatus::OK => return None,
                DiagnosticStatus::WARN => "warn",
                DiagnosticStatus::STALE => "stale",
                _ => "error",
            };
            Some(Alarm { level, name, message: &known.message })
        });
        let mut all: Vec<_> = collisions.chain(states).collect();
        all.sort_by_key(|alarm| ["error", "stale", "warn"].iter().position(|level| *level == alarm.level));
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn say(alarms: &mut Alarms, at: f64, name: &str, level: u8) -> bool {
        let status = DiagnosticStatus { name: name.to_owned(), level, message: "m".to_owned(), ..Default::default() };
        alarms.take(RosTime(0).plus_seconds(at), DiagnosticArray { status: vec![status], ..Default::default() })
    }

    #[test]
    fn alarms_come_sort_age_and_go() {
        let mut alarms = Alarms::default();
        assert!(!say(&mut alarms, 0.0, "/a: x", DiagnosticStatus::OK));
        assert!(say(&mut alarms, 0.0, "/b: x", DiagnosticStatus::WARN));
        assert!(say(&mut alarms, 0.0, "/c: x", DiagnosticStatus::ERROR));
        let shown = |alarms: &Alarms, at: f64| -> Vec<(String, &str)> {
            let list = alarms.list(RosTime(0).plus_seconds(at));
            list.iter().map(|alarm| (alarm.name.to_owned(), alarm.level)).collect()
        };
        assert_eq!(shown(&alarms, 1.0), [("/c: x".to_owned(), "error"), ("/b: x".to_owned(), "warn")]);
        assert!(say(&mut alarms, 3.0, "/c: x", DiagnosticStatus::OK));
        let stale = [("/a: x".to_owned(), "stale"), ("/b: x".to_owned(), "stale")];
        assert_eq!(shown(&alarms, 4.0), stale, "who is not heard any more is told, in whatever state it was");
    }
}
