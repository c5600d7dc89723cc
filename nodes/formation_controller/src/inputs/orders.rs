//! Which assignment, formation and run state count, where more than one node says any.
//!
//! They are latched: said once, for good. Goals come with every frame, and who says them is pinned ([`trench_core::Master`]); they
//! carry the epoch of their assignment. So that assignment counts which the goals are of, that formation which the assignment
//! is for, and that run state which is of this epoch, or by the same one of the next, or the last one before: a stranger's are heard, and change
//! nothing. One who copies the epoch is no stranger who errs but one who means it: against those, docs/hosts.md.

use super::Inputs;
use crate::segments::Segments;
use std::cmp::Reverse;
use std::sync::Arc;
use trench_core::Latched;
use trench_msgs::msg::{Assignment, RunState};

/// Everybody's words.
#[derive(Debug, Clone, Default)]
pub(crate) struct Orders {
    assignments: Latched<Assignment>,
    formations: Latched<Arc<Segments>>,
    runs: Latched<RunState>,
}

impl Orders {
    /// Whether some assignment in force, by whomever, has this epoch.
    pub(super) fn has(&self, epoch: u64) -> bool {
        self.assignments.words().any(|(_, assignment)| assignment.epoch == epoch)
    }
}

impl Inputs {
    /// Takes an assignment; whether it counts.
    pub(crate) fn take_assignment(&mut self, publisher: [u8; 16], message: Assignment) -> bool {
        self.orders.assignments.hear(publisher, message);
        self.choose_assignment() == Some(publisher)
    }

    /// Takes a formation; whether it counts.
    pub(crate) fn take_formation(&mut self, publisher: [u8; 16], message: Segments) -> bool {
        self.orders.formations.hear(publisher, Arc::new(message));
        self.choose_formation() == Some(publisher)
    }

    /// Takes a run state; whether it counts.
    pub(crate) fn take_run(&mut self, publisher: [u8; 16], message: RunState) -> bool {
        self.orders.runs.hear(publisher, message);
        self.choose_run() == Some(publisher)
    }

    /// The goals are of another epoch than before.
    pub(super) fn choose_again(&mut self) {
        if self.orders.assignments.are_several() {
            self.choose_assignment();
        }
        if self.orders.runs.are_several() {
            self.choose_run();
        }
    }

    /// The goals' own, or what comes next after it.
    fn choose_assignment(&mut self) -> Option<[u8; 16]> {
        let epoch = self.goals.epoch();
        let (gid, chosen) =
            self.orders.assignments.choose(|word| (word.epoch >= epoch).then_some(Reverse(word.epoch)))?;
        let gid = *gid;
        self.assignment = Some(chosen.clone());
        if self.orders.formations.are_several() {
            self.choose_formation();
        }
        Some(gid)
    }

    fn choose_formation(&mut self) -> Option<[u8; 16]> {
        let hash = self.assignment.as_ref().map(|assignment| assignment.formation_hash);
        let (gid, chosen) = self.orders.formations.choose(|word| hash.filter(|hash| *hash == word.formation_hash))?;
        self.segments = Some(chosen.clone());
        Some(*gid)
    }

    fn choose_run(&mut self) -> Option<[u8; 16]> {
        let epoch = self.goals.epoch();
        let (gid, chosen) = self.orders.runs.follow(epoch, |word| word.epoch)?;
        let gid = *gid;
        self.run = Some(chosen.clone());
        Some(gid)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_core::{RosTime, Steady, Times};
    use trench_msgs::msg::Goals;

    const OURS: [u8; 16] = [1; 16];
    const STRANGER: [u8; 16] = [2; 16];
    const AGAIN: [u8; 16] = [3; 16];

    fn assignment(epoch: u64) -> Assignment {
        Assignment { epoch, formation_hash: epoch, ..Assignment::default() }
    }

    fn run(epoch: u64, state: u8) -> RunState {
        RunState { epoch, state, ..RunState::default() }
    }

    fn hear_goals(inputs: &mut Inputs, epoch: u64, tenths: u64) -> bool {
        let at = Times { ros: RosTime(tenths as i64 * 100_000_000), steady: Steady(tenths * 100_000_000) };
        let mut message = Goals { epoch, ..Goals::default() };
        message.header.stamp = at.ros.into();
        inputs.take_goals(at, message).is_ok()
    }

    fn state(inputs: &Inputs) -> (u64, u8) {
        (inputs.assignment.as_ref().unwrap().epoch, inputs.run.as_ref().unwrap().state)
    }

    /// Inputs while our run of epoch 5 runs.
    fn running() -> Inputs {
        let mut inputs = Inputs::default();
        assert!(inputs.take_assignment(OURS, assignment(5)) && inputs.take_run(OURS, run(5, RunState::RUNNING)));
        assert!(hear_goals(&mut inputs, 5, 1));
        inputs
    }

    #[test]
    fn a_stranger_s_words_change_nothing() {
        for epoch in [0, 1, 4, 6, 1 << 63] {
            let mut inputs = running();
            assert!(!inputs.take_assignment(STRANGER, assignment(epoch)), "{epoch}");
            inputs.take_run(STRANGER, run(if epoch == 5 { 4 } else { epoch }, RunState::STOPPED));
            assert_eq!(state(&inputs), (5, RunState::RUNNING), "{epoch}");
            assert!(hear_goals(&mut inputs, 5, 2), "{epoch}");
            // Our next assignment, with the stranger's still said; the goals of it come last.
            inputs.take_assignment(OURS, assignment(6));
            assert!(inputs.take_run(OURS, run(6, RunState::RUNNING)), "{epoch}");
            assert_eq!(inputs.run.as_ref().unwrap().state, RunState::RUNNING, "{epoch}");
            assert!(hear_goals(&mut inputs, 6, 3), "{epoch}");
            assert_eq!(state(&inputs).0, 6, "{epoch}");
            assert!(!hear_goals(&mut inputs, 5, 4) || epoch == 5, "{epoch}: goals of an assignment that was replaced");
            assert!(inputs.take_run(OURS, run(6, RunState::STOPPED)), "{epoch}");
            assert_eq!(state(&inputs).1, RunState::STOPPED, "{epoch}");
        }
    }

    /// A stranger that comes first, before goals are heard, is not in the way of ours.
    #[test]
    fn who_spoke_first_is_passed_by() {
        let mut inputs = Inputs::default();
        inputs.take_assignment(STRANGER, assignment(1 << 63));
        inputs.take_run(STRANGER, run(1 << 63, RunState::RUNNING));
        inputs.take_assignment(OURS, assignment(5));
        inputs.take_run(OURS, run(5, RunState::IDLE));
        assert_eq!(state(&inputs), (5, RunState::IDLE));
        assert!(hear_goals(&mut inputs, 5, 1));
        inputs.take_run(STRANGER, run(1 << 63, RunState::RUNNING));
        assert_eq!(state(&inputs), (5, RunState::IDLE));
    }

    /// Of ours, killed and started again: with its epoch, with the next one, or from the beginning.
    #[test]
    fn a_later_life_of_ours_takes_over() {
        for epoch in [5, 6, 1] {
            let mut inputs = running();
            inputs.take_assignment(AGAIN, assignment(epoch));
            inputs.take_run(AGAIN, run(epoch, RunState::STOPPED));
            assert!(hear_goals(&mut inputs, epoch, 9), "{epoch}");
            assert_eq!(state(&inputs), (epoch, RunState::STOPPED), "{epoch}");
        }
    }
}
