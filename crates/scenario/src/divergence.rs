//! Runs that no theory describes any more: a robot that is far out of all that the file speaks of.

use crate::summary::DivergedSummary;
use crate::{Scenario, Seat, Task};
use trench_formation::Vector2;
use trench_formation::curve::Curve;
use trench_formation::kinematics::PointState;

/// A robot has diverged this many times as far out as anything that the file speaks of.
const FAR: f64 = 1000.0;
/// Nothing is smaller than this, m.
const LEAST: f64 = 1.0;
/// What can be done about it.
const REMEDY: &str = "make the step smaller, or the gains";

/// Looks for the first robot that is a thousand times as far from the origin as the farthest of what the file speaks of: starts, goal points
/// and the segment's end points, with the way that these move until the end of the run.
#[derive(Debug, Clone)]
pub(crate) struct Divergence {
    /// m.
    limit: f64,
    first: Option<DivergedSummary>,
}

impl Divergence {
    pub(crate) fn new(scenario: &Scenario) -> Self {
        let farthest = places(scenario).into_iter().map(|place| place.norm()).fold(LEAST, f64::max);
        Self { limit: FAR * farthest, first: None }
    }

    /// Looks at a robot that is at `position` (m) at `time` (s). As far as it may go until it has to be looked at again, m.
    pub(crate) fn look(&mut self, seat: &Seat, position: Vector2<f64>, time: f64) -> f64 {
        // Not below either is what is no number.
        let is_within = position.norm_squared() < self.limit * self.limit;
        if !is_within && self.first.is_none() {
            let (robot, distance) = (seat.name.clone(), position.norm());
            self.first = Some(DivergedSummary { time, robot, distance, limit: self.limit, remedy: REMEDY });
        }
        self.limit - position.norm()
    }

    pub(crate) fn first(&self) -> Option<&DivergedSummary> {
        self.first.as_ref()
    }
}

fn places(scenario: &Scenario) -> Vec<Vector2<f64>> {
    let duration = scenario.timing.duration;
    let positions = |robots: &[PointState]| robots.iter().map(|robot| robot.position).collect::<Vec<_>>();
    let ends = |curve: &Curve| [0.0, curve.length()].map(|at| curve.at(at).point);
    match &scenario.task {
        Task::Regulating(task) => task.starts.iter().map(|start| start.0.position()).chain([task.goal]).collect(),
        Task::GoalTracking(task) => {
            let goals = [0.0, duration]
                .into_iter()
                .flat_map(|time| (0..task.robots.len()).map(move |index| task.goals.at(index, time).position));
            positions(&task.robots).into_iter().chain(goals).collect()
        }
        Task::Directed(task) => {
            positions(&task.chain.robots).into_iter().chain([task.chain.team_goal]).chain(ends(&task.curve)).collect()
        }
        Task::Nearest(chain, _) => {
            let (origin, way) = (chain.carriage.origin, duration * chain.carriage.velocity);
            let segment = ends(&chain.segment).into_iter().chain(chain.team_goal);
            let moved = segment.flat_map(|place| {
                // Whichever way the frame is turned.
                let out = place.norm() + origin.norm();
                [Vector2::new(out, 0.0), Vector2::new(out + way.norm(), 0.0)]
            });
            positions(&chain.robots).into_iter().chain(moved).collect()
        }
        Task::Queue(task) => {
            let starts = task.queue.robots.iter().map(|robot| robot.start.position);
            starts.chain([task.queue.target]).chain(ends(&task.queue.segment)).collect()
        }
        Task::Launch(_) => Vec::new(),
    }
}
