//! Which robots and obstacles of a scenario its safety filter keeps apart.

use crate::Verdict;
use crate::stopping::stopping;
use trench_formation::Vector2;
use trench_formation::hull::{Obstacle, Outline};
use trench_formation::kinematics::PointState;
use trench_formation::safety::Stopping;
use trench_formation::simulate::{ChainScenario, QueueScenario};
use trench_scenario::Bounds;

/// Of a chain: obstacles that move do not brake, and are no promise of the filter's.
pub(crate) fn stopping_of_chain<T>(subject: &str, task: &ChainScenario<T>) -> Option<Verdict> {
    let filter = task.options.safety.as_ref()?;
    let moves = |index: usize| task.options.obstacle_velocities.get(index).is_some_and(|it| *it != Vector2::zeros());
    let resting = task.obstacles.iter().enumerate().filter(|(index, _)| !moves(*index));
    let outlines: Vec<(u32, Outline<'_>)> = resting.map(|(_, Obstacle { id, shape })| (*id, shape.outline())).collect();
    Some(stopping(subject, filter, &task.robots, &outlines))
}

/// Of a queue: who joins later stands until then.
pub(crate) fn stopping_of_queue(subject: &str, queue: &QueueScenario) -> Option<Verdict> {
    let filter = queue.safety.as_ref()?;
    let at_start = |joins: Option<f64>, start: PointState| match joins {
        Some(_) => PointState::at_rest(start.position),
        None => start,
    };
    let robots: Vec<PointState> = queue.robots.iter().map(|robot| at_start(robot.joins, robot.start)).collect();
    Some(stopping(subject, filter, &robots, &[]))
}

/// Of robots that track goal points.
pub(crate) fn stopping_of_goals(subject: &str, bounds: &Bounds, robots: &[PointState]) -> Option<Verdict> {
    let filter = Stopping { radius: bounds.radius?, capability: bounds.limits };
    Some(stopping(subject, &filter, robots, &[]))
}
