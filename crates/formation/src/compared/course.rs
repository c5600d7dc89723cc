//! A robot on its way among walls.
use super::Guide;
use crate::Vector2;
use crate::avoidance::{ComparedRepulsion, WatchSettings};
use crate::hull::{Approach, HullError, Outline, Shape};
use crate::kinematics::PointState;

/// Walls, a goal point, and the potentials that all methods share.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// m.
    pub goal: Vector2<f64>,
    /// Corners of each obstacle's open chain of walls, m.
    pub obstacles: Vec<Vec<Vector2<f64>>>,
    /// U_rep.
    pub repulsion: ComparedRepulsion,
    /// Pull of the attraction, alpha d/sqrt(d^2 + 1), m/s^2.
    pub pull: f64,
    /// 1/s.
    pub damping: f64,
    /// When the robot counts as caught; `arrived` also ends the run.
    pub watch: WatchSettings,
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// s, if the robot arrived.
    pub arrived: Option<f64>,
    /// m, at the end.
    pub position: Vector2<f64>,
    /// Length of the path, m.
    pub length: f64,
    /// Least distance from a wall, m.
    pub least_gap: f64,
    /// See [`Guide::recoveries`].
    pub recoveries: u32,
}

impl Course {
    /// Drives a robot that starts at rest for at most `duration` (s), by semi-implicit Euler in steps of `step` (s).
    ///
    /// # Errors
    /// Obstacles without a corner, or corners that are not finite.
    pub fn drive(
        &self,
        guide: &mut impl Guide,
        start: Vector2<f64>,
        duration: f64,
        step: f64,
    ) -> Result<Outcome, HullError> {
        let mut trip = Trip::new(self.clone(), guide, start)?;
        for _ in 0..(duration / step) as u64 {
            if trip.outcome().arrived.is_some() {
                break;
            }
            trip.step(step);
        }
        Ok(trip.outcome())
    }

    /// Each obstacle's walls.
    pub(super) fn walls(&self) -> Result<Vec<Vec<Shape>>, HullError> {
        let of = |corners: &Vec<Vector2<f64>>| corners.windows(2).map(|pair| Shape::new(pair, 0.0)).collect();
        self.obstacles.iter().map(of).collect()
    }

    /// The nearest of all walls.
    pub(super) fn approach(&self, point: Vector2<f64>) -> Approach {
        let pairs = self.obstacles.iter().flat_map(|corners| corners.windows(2));
        let approaches = pairs.map(|points| Outline { points, radius: 0.0 }.approach(point));
        approaches.min_by(|a, b| a.gap.total_cmp(&b.gap)).unwrap_or(NOWHERE)
    }

    /// Least distance of any wall from a point, m.
    pub(super) fn gap(&self, point: Vector2<f64>) -> f64 {
        self.approach(point).gap
    }

    /// Whether the straight way keeps `clearance` (m) from all walls.
    pub(super) fn is_clear(&self, from: Vector2<f64>, to: Vector2<f64>, clearance: f64) -> bool {
        let count = libm::ceil((to - from).norm() / (0.25 * clearance)).max(1.0) as u32;
        (1..=count).all(|step| self.gap(from + (to - from) * (f64::from(step) / f64::from(count))) >= clearance)
    }
}

/// A robot under way.
#[derive(Debug, Clone)]
pub struct Trip<G> {
    course: Course,
    guide: G,
    walls: Vec<Vec<Shape>>,
    hulls: Vec<Shape>,
    robot: PointState,
    time: f64,
    outcome: Outcome,
}

impl<G: Guide> Trip<G> {
    /// At rest at `start` (m).
    ///
    /// # Errors
    /// Obstacles without a corner, or corners that are not finite.
    pub fn new(course: Course, guide: G, start: Vector2<f64>) -> Result<Self, HullError> {
        let walls = course.walls()?;
        let hulls = course.obstacles.iter().map(|corners| Shape::enclosing(corners, 0.0)).collect::<Result<_, _>>()?;
        let outcome = Outcome { arrived: None, position: start, length: 0.0, least_gap: f64::INFINITY, recoveries: 0 };
        Ok(Self { course, guide, walls, hulls, robot: PointState::at_rest(start), time: 0.0, outcome })
    }

    /// Advances by `step` (s), by semi-implicit Euler. A robot that has arrived stays.
    pub fn step(&mut self, step: f64) {
        let Self { course, guide, walls, hulls, robot, time, outcome } = self;
        if outcome.arrived.is_some() {
            return;
        }
        let target = guide.target(course, *time, robot.position);
        let to_target = target - robot.position;
        let mut force = to_target * (course.pull / (1.0 + to_target.norm_squared()).sqrt());
        for (obstacle, walls) in walls.iter().enumerate() {
            let nearest = nearest(walls, robot.position);
            outcome.least_gap = outcome.least_gap.min(nearest.gap);
            let hull = hulls[obstacle].outline().approach(robot.position);
            let is_closed = guide.repelling().contains(&obstacle);
            force += course.repulsion.push(if is_closed { hull } else { nearest }, to_target).force;
        }
        let before = robot.position;
        *robot = robot.advanced_semi_implicit(force - course.damping * robot.velocity, step);
        *time += step;
        outcome.length += (robot.position - before).norm();
        outcome.position = robot.position;
        outcome.recoveries = guide.recoveries();
        if (course.goal - robot.position).norm() <= course.watch.arrived {
            outcome.arrived = Some(*time);
            robot.velocity = Vector2::zeros();
        }
    }

    /// The robot.
    pub fn robot(&self) -> PointState {
        self.robot
    }

    /// Where it goes, m.
    pub fn goal(&self) -> Vector2<f64> {
        self.course.goal
    }

    /// What has come of it so far.
    pub fn outcome(&self) -> Outcome {
        self.outcome
    }
}

/// Where there are no walls.
const NOWHERE: Approach = Approach { gap: f64::INFINITY, towards: Vector2::new(1.0, 0.0) };

fn nearest(walls: &[Shape], point: Vector2<f64>) -> Approach {
    let approaches = walls.iter().map(|wall| wall.outline().approach(point));
    approaches.min_by(|a, b| a.gap.total_cmp(&b.gap)).unwrap_or(NOWHERE)
}
