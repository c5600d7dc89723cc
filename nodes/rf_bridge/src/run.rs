//! Whether the run is running, where more than one node says something about that.
//!
//! /run_state is latched: each word is said once. A stranger's must not make ours unsaid, or robots would stand for good; so robots
//! may drive while anybody says that the run is running. They do not drive by a stranger's word: controllers ask whose run
//! it is (by the epoch of the goals), and command zero. Who stops whatever happens is /emergency_stop.

use std::collections::VecDeque;
use trench_core::RosTime;
use trench_msgs::msg::RunState;

/// Publishers whose words are kept.
const MOST: usize = 16;

#[derive(Debug, Clone, Copy)]
struct Word {
    publisher: [u8; 16],
    /// When the run began that it is about; zero before it has.
    t0: RosTime,
    running: bool,
}

/// The last word of each.
#[derive(Debug, Clone, Default)]
pub(crate) struct Run(VecDeque<Word>);

impl Run {
    /// Takes a word. A later life of who said an earlier one speaks of the same run: then that one is over.
    pub(crate) fn hear(&mut self, publisher: [u8; 16], message: &RunState) {
        let word = Word { publisher, t0: (&message.t0).into(), running: message.state == RunState::RUNNING };
        let same_run = |other: &Word| word.t0.0 != 0 && other.t0 == word.t0;
        self.0.retain(|other| other.publisher != publisher && !same_run(other));
        if self.0.len() >= MOST {
            self.0.pop_front();
        }
        self.0.push_back(word);
    }

    /// Whether robots may drive.
    pub(crate) fn is_running(&self) -> bool {
        self.0.iter().any(|word| word.running)
    }

    /// Whether publishers contradict each other.
    pub(crate) fn is_disputed(&self) -> bool {
        self.is_running() && self.0.iter().any(|word| !word.running)
    }

    /// Nobody has said anything: the process ends.
    pub(crate) fn forget(&mut self) {
        self.0.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// After these words (publisher, state, t0 in s): whether robots may drive.
    fn check(said: &[(u8, u8, i64)], running: bool) {
        let mut run = Run::default();
        for (publisher, state, t0) in said {
            let t0 = RosTime(t0 * 1_000_000_000).into();
            run.hear([*publisher; 16], &RunState { state: *state, t0, ..RunState::default() });
        }
        assert_eq!(run.is_running(), running, "{said:?}");
    }

    #[test]
    fn who_says_what() {
        let (idle, going, stopped) = (RunState::IDLE, RunState::RUNNING, RunState::STOPPED);
        check(&[], false);
        check(&[(1, idle, 0), (1, going, 0), (1, going, 7)], true);
        check(&[(1, going, 7), (1, stopped, 7)], false);
        // A stranger who idles stops nobody, and our word counts afterwards.
        check(&[(1, going, 7), (2, idle, 0)], true);
        check(&[(1, going, 7), (2, idle, 0), (1, stopped, 7)], false);
        // A later life of ours.
        check(&[(1, going, 7), (3, stopped, 7)], false);
        check(&[(1, going, 7), (3, going, 7), (3, stopped, 7)], false);
    }
}
