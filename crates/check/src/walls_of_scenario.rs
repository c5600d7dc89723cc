//! What zones and obstacles of a scenario are held against.

use crate::Verdict;
use crate::scenario::{RANGE, least_sine};
use crate::stiffness::steepest;
use crate::verdict::number;
use crate::walls::{Coming, Wall, walls};
use trench_formation::Vector2;
use trench_formation::kinematics::PointState;
use trench_formation::laws::Capability;
use trench_formation::simulate::{ChainScenario, ZonedChainScenario};
use trench_formation::trench::AnyTrench;

/// Keys of a scenario's walls.
const ZONES: &str = "zoning.full_acceleration";
const OBSTACLES: &str = "obstacle_potential.full_acceleration";

/// Whether zones hold against the trench along directions of attraction.
pub(crate) fn walls_of_directed(subject: &str, chain: &ZonedChainScenario<AnyTrench>) -> Option<Verdict> {
    let pull = steepest(&chain.law.trench, RANGE) / least_turn(chain);
    let coming = coming(pull, chain.law.damping, &chain.robots, Vector2::zeros(), None);
    let all = (chain.robots.len() > 1).then(|| Wall::zones(&chain.law.zoning, ZONES));
    walls(subject, &coming, all.as_slice())
}

/// Whether zones and obstacles hold against the trench.
pub(crate) fn walls_of_nearest(subject: &str, task: &ChainScenario<AnyTrench>) -> Option<Verdict> {
    let (pull, still) = (steepest(&task.law.trench, RANGE) / least_sine(task), task.carriage.velocity);
    let mut all = Vec::new();
    if task.robots.len() > 1 {
        all.push(Wall::zones(&task.zoning, ZONES));
    }
    if !task.obstacles.is_empty() {
        let velocities = task.options.obstacle_velocities.iter();
        let fastest = velocities.map(|velocity| (velocity - still).norm()).fold(0.0, f64::max);
        all.push(Wall::obstacles(&task.potential, OBSTACLES, fastest));
    }
    walls(subject, &coming(pull, task.law.damping, &task.robots, still, task.options.limits), &all)
}

/// What the trench makes of robots, on a segment that moves at `still` (m/s), up to the limit; or the fastest at its start, if that is more.
fn coming(pull: f64, damping: f64, robots: &[PointState], still: Vector2<f64>, limits: Option<Capability>) -> Coming {
    let drawn = pull / damping;
    let (usual, because) = match limits {
        Some(limits) if limits.speed < drawn => (limits.speed, "limits.speed"),
        _ => (drawn, "pull over damping"),
    };
    let starts = robots.iter().map(|robot| (robot.velocity - still).norm()).enumerate();
    match starts.max_by(|(_, one), (_, other)| one.total_cmp(other)) {
        Some((index, speed)) if speed > usual => {
            let faster = match limits {
                Some(limits) if limits.speed < speed => format!(", above limits.speed = {}", number(limits.speed)),
                _ => String::new(),
            };
            Coming { pull, speed, because: format!("with which r{} begins{faster}", index + 1) }
        }
        _ => Coming { pull, speed: usual, because: because.to_owned() },
    }
}

/// Sine of the least angle between the directions of attraction of a chain and its segment.
pub(crate) fn least_turn(chain: &ZonedChainScenario<AnyTrench>) -> f64 {
    chain.directions.iter().map(|along| along.normalize().perp(&chain.tangent).abs()).fold(1.0, f64::min)
}
