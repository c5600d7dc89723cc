//! Whether the run is running, where more than one node says something about that.
//!
//! /run_state is latched: each word is said once. A stranger's must not make ours unsaid, or robots would stand for good; so robots
//! may drive while anybody says that the run is running. They do not drive by a stranger's word: controllers ask whose run
//! it is (by the epoch of the goals), and command zero. Who stops whatever happens is /emergency_stop. What somebody said who has gone
//! counts for nothing until that publisher is there again: the network may have lost it for a while, and it need not say it twice.

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
    /// Whether who said it has gone.
    gone: bool,
}

/// The last word of each.
#[derive(Debug, Clone, Default)]
pub(crate) struct Run(VecDeque<Word>);

impl Run {
    /// Takes a word. A later life of who said an earlier one speaks of the same run: then that one is over.
    pub(crate) fn hear(&mut self, publisher: [u8; 16], message: &RunState) {
        let running = message.state == RunState::RUNNING;
        let word = Word { publisher, t0: (&message.t0).into(), running, gone: false };
        let same_run = |other: &Word| word.t0.0 != 0 && other.t0 == word.t0;
        self.0.retain(|other| other.publisher != publisher && !same_run(other));
        if self.0.len() >= MOST {
            self.0.remove(self.least());
        }
        self.0.push_back(word);
    }

    /// Whose word is missed least: of somebody who has gone; else of one who does not say that it runs, so that whoever does, ours among
    /// them, is not drowned out; else the oldest.
    fn least(&self) -> usize {
        let first = |is: fn(&Word) -> bool| self.0.iter().position(is);
        first(|word| word.gone).or_else(|| first(|word| !word.running)).unwrap_or(0)
    }

    /// A publisher has come, or gone.
    pub(crate) fn presence(&mut self, publisher: [u8; 16], is_there: bool) {
        for word in self.0.iter_mut().filter(|word| word.publisher == publisher) {
            word.gone = !is_there;
        }
    }

    /// Whether robots may drive.
    pub(crate) fn is_running(&self) -> bool {
        self.said().any(|word| word.running)
    }

    /// Whether publishers contradict each other.
    pub(crate) fn is_disputed(&self) -> bool {
        self.is_running() && self.said().any(|word| !word.running)
    }

    fn said(&self) -> impl Iterator<Item = &Word> {
        self.0.iter().filter(|word| !word.gone)
    }

    /// Nobody has said anything: the process ends.
    pub(crate) fn forget(&mut self) {
        self.0.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a publisher does: says a state of the run that began at t0 (s), goes, or comes back.
    #[derive(Debug, Clone, Copy)]
    enum Act {
        Says(u8, i64),
        Goes,
        Comes,
    }
    use Act::{Comes, Goes, Says};

    /// After these acts (publisher, act): whether robots may drive.
    fn check(acts: &[(u8, Act)], running: bool) {
        let mut run = Run::default();
        for (publisher, act) in acts {
            match act {
                Says(state, t0) => {
                    let t0 = RosTime(t0 * 1_000_000_000).into();
                    run.hear([*publisher; 16], &RunState { state: *state, t0, ..RunState::default() });
                }
                Goes => run.presence([*publisher; 16], false),
                Comes => run.presence([*publisher; 16], true),
            }
        }
        assert_eq!(run.is_running(), running, "{acts:?}");
    }

    #[test]
    fn who_says_what() {
        let going = Says(RunState::RUNNING, 7);
        let (idle, stopped) = (Says(RunState::IDLE, 0), Says(RunState::STOPPED, 7));
        check(&[], false);
        check(&[(1, idle), (1, Says(RunState::RUNNING, 0)), (1, going)], true);
        check(&[(1, going), (1, stopped)], false);
        // A stranger who idles stops nobody, and our word counts afterwards.
        check(&[(1, going), (2, idle)], true);
        check(&[(1, going), (2, idle), (1, stopped)], false);
        // A later life of ours.
        check(&[(1, going), (3, stopped)], false);
        check(&[(1, going), (3, going), (3, stopped)], false);
    }

    #[test]
    fn twenty_strangers_do_not_make_our_word_unsaid() {
        let running = |run: &mut Run, publisher: u8, state: u8| {
            run.hear([publisher; 16], &RunState { state, t0: RosTime(7).into(), ..RunState::default() });
            run.is_running()
        };
        let stranger = |run: &mut Run, publisher: u8, state: u8, goes: bool| {
            run.hear([publisher; 16], &RunState { state, ..RunState::default() });
            if goes {
                run.presence([publisher; 16], false);
            }
        };
        for (state, goes) in [(RunState::IDLE, true), (RunState::IDLE, false), (RunState::RUNNING, true)] {
            let mut run = Run::default();
            (100..120).for_each(|publisher| stranger(&mut run, publisher, state, goes));
            assert!(running(&mut run, 1, RunState::RUNNING));
            (120..140).for_each(|publisher| stranger(&mut run, publisher, state, goes));
            assert!(run.is_running(), "{state} {goes}");
            assert!(!running(&mut run, 1, RunState::STOPPED), "{state} {goes}");
        }
    }

    #[test]
    fn words_of_those_who_have_gone_count_for_nothing() {
        let (going, stranger) = (Says(RunState::RUNNING, 7), Says(RunState::RUNNING, 0));
        let (idle, stopped) = (Says(RunState::IDLE, 0), Says(RunState::STOPPED, 7));
        check(&[(1, going), (1, Goes)], false);
        check(&[(1, going), (1, Goes), (4, idle)], false);
        // A stranger who said that it runs and went holds the gate open for nobody.
        check(&[(2, stranger), (1, going), (1, stopped)], true);
        check(&[(2, stranger), (2, Goes), (1, going), (1, stopped)], false);
        check(&[(2, stranger), (1, going), (2, Goes)], true);
        // The network lost it for a while.
        check(&[(1, going), (1, Goes), (1, Comes)], true);
        // The life before is missed only after the next one has spoken.
        check(&[(1, going), (3, going), (1, Goes)], true);
    }
}
