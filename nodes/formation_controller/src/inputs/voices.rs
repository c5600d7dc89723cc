//! Who speaks for a robot: two controllers of one robot are one too many.

use std::collections::BTreeMap;
use trench_core::Steady;

/// A writer that has been silent for so long speaks no more, s.
const SILENT: f64 = 0.3;

/// The writers of every robot's leader state, and when each was heard last.
#[derive(Debug, Clone, Default)]
pub(crate) struct Voices(BTreeMap<String, BTreeMap<[u8; 16], Steady>>);

impl Voices {
    /// A leader state of `robot` came from the writer `gid`.
    pub(crate) fn hear(&mut self, robot: &str, gid: [u8; 16], now: Steady) {
        if !self.0.contains_key(robot) {
            self.0.insert(robot.to_owned(), BTreeMap::new());
        }
        if let Some(writers) = self.0.get_mut(robot) {
            writers.retain(|_, last| now.seconds_since(*last) <= SILENT);
            writers.insert(gid, now);
        }
    }

    /// Whether several controllers speak for `robot`.
    pub(crate) fn are_several(&self, robot: &str, now: Steady) -> bool {
        self.0
            .get(robot)
            .is_some_and(|writers| writers.values().filter(|last| now.seconds_since(**last) <= SILENT).count() > 1)
    }

    /// The robots for which several controllers speak.
    pub(crate) fn doubled(&self, now: Steady) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str).filter(move |robot| self.are_several(robot, now))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_controller_that_took_over_is_alone_soon() {
        let at = |seconds: f64| Steady(0).plus_seconds(seconds);
        let mut voices = Voices::default();
        voices.hear("robot1", [1; 16], at(0.0));
        voices.hear("robot2", [2; 16], at(0.0));
        assert!(!voices.are_several("robot1", at(0.0)));
        voices.hear("robot1", [3; 16], at(0.1));
        assert_eq!(voices.doubled(at(0.2)).collect::<Vec<_>>(), ["robot1"]);
        voices.hear("robot1", [3; 16], at(0.35));
        assert!(!voices.are_several("robot1", at(0.35)));
    }
}
