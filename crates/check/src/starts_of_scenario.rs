//! What draws the followers of a scenario that begin in zone 5.

use crate::Verdict;
use crate::drawn::Drawn;
use crate::scenario::{RANGE, least_sine};
use crate::starts::starts;
use crate::stiffness::steepest;
use crate::walls_of_scenario::least_turn;
use trench_formation::simulate::{ChainScenario, ZonedChainScenario};
use trench_formation::trench::AnyTrench;

/// Of a chain along directions of attraction.
pub(crate) fn starts_of_directed(subject: &str, chain: &ZonedChainScenario<AnyTrench>) -> Option<Verdict> {
    let drawn = Drawn {
        robots: &chain.robots,
        zoning: &chain.law.zoning,
        damping: chain.law.damping + chain.law.leader_damping,
        limits: None,
        pull: steepest(&chain.law.trench, RANGE) / least_turn(chain),
    };
    starts(subject, &drawn)
}

/// Of a chain of chapter 7.
pub(crate) fn starts_of_nearest(subject: &str, task: &ChainScenario<AnyTrench>) -> Option<Verdict> {
    let drawn = Drawn {
        robots: &task.robots,
        zoning: &task.zoning,
        damping: task.law.damping + task.law.leader_damping,
        limits: task.options.limits,
        pull: steepest(&task.law.trench, RANGE) / least_sine(task),
    };
    starts(subject, &drawn)
}
