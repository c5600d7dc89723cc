//! What decides whether the chain of a scenario whips.

use crate::damping::Damped;
use crate::scenario::{RANGE, least_sine};
use crate::stiffness::steepest;
use crate::walls_of_scenario::least_turn;
use trench_formation::simulate::{ChainScenario, ZonedChainScenario};
use trench_formation::trench::AnyTrench;

/// Of a chain along directions of attraction.
pub(crate) fn damped_directed(chain: &ZonedChainScenario<AnyTrench>) -> Damped {
    let far = |robot: usize| {
        let state = chain.robots[robot];
        let to = if robot == 0 { chain.team_goal } else { chain.attraction(state, robot).point };
        (to - state.position).norm()
    };
    let farthest = (0..chain.robots.len()).map(far).fold(0.0, f64::max);
    Damped {
        damping: chain.law.damping,
        leader_damping: chain.law.leader_damping,
        pull: pull(&chain.law.trench, farthest) / least_turn(chain),
        speed: f64::INFINITY,
        robots: Some(chain.robots.len()),
        zones: chain.law.zoning,
        obstacles: None,
    }
}

/// Of a chain of chapter 7.
pub(crate) fn damped_nearest(task: &ChainScenario<AnyTrench>) -> Damped {
    let frame = task.carriage.at(0.0).0;
    let nearest = |robot: &trench_formation::kinematics::PointState| {
        let own = frame.inverse_transform_point(&robot.position.into()).coords;
        task.segment.nearest(own).distance
    };
    let first = task
        .robots
        .first()
        .zip(task.team_goal)
        .map_or(0.0, |(robot, goal)| (frame.transform_point(&goal.into()).coords - robot.position).norm());
    let farthest = task.robots.iter().map(nearest).fold(first, f64::max);
    let (limits, pull) = (task.options.limits, pull(&task.law.trench, farthest) / least_sine(task));
    Damped {
        damping: task.law.damping,
        leader_damping: task.law.leader_damping,
        pull: limits.map_or(pull, |limits| limits.acceleration.min(pull)),
        speed: limits.map_or(f64::INFINITY, |limits| limits.speed),
        robots: Some(task.robots.len()),
        zones: task.zoning,
        obstacles: (!task.obstacles.is_empty()).then_some(task.potential),
    }
}

/// The largest pull of a trench as far as robots begin from what draws them, m/s^2.
fn pull(trench: &AnyTrench, farthest: f64) -> f64 {
    steepest(trench, farthest.clamp(1.0, RANGE))
}
