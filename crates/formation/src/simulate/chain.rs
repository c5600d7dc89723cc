//! Stepping a chain.
use super::remedy::Remedy;
use super::{ChainScenario, Encroaching, ScenarioError};
use crate::Vector2;
use crate::hull::{ApparentObstacle, Obstacle, combine};
use crate::kinematics::PointState;
use crate::laws::{Attracting, Push, RigidMotion, Steered};
use crate::seek::{Fragments, Seeker};
use crate::trench::Trench;
use nalgebra::Isometry2;

/// A chain under way.
#[derive(Debug, Clone)]
pub struct ChainSimulation<T> {
    pub(super) scenario: ChainScenario<T>,
    pub(super) obstacles: Vec<ApparentObstacle>,
    pub(super) robots: Vec<PointState>,
    /// Robots at the last tick, as others see them.
    pub(super) seen: Vec<PointState>,
    pub(super) seekers: Vec<Seeker>,
    pub(super) remedies: Vec<Remedy>,
    /// Distances from the nearest points at the last step, m.
    pub(super) deviations: Vec<f64>,
    /// Fragments of each robot, or one for all.
    pub(super) fragments: Vec<Fragments>,
    pub(super) steered: Vec<Steered>,
    pub(super) frame: (Isometry2<f64>, RigidMotion),
    pub(super) steps: u64,
}

impl<T: Trench> ChainSimulation<T> {
    /// Combines the obstacles and puts the robots at their start.
    ///
    /// # Errors
    /// See [`ScenarioError`].
    pub fn new(scenario: ChainScenario<T>) -> Result<Self, ScenarioError> {
        scenario.check()?;
        let obstacles = combine(&scenario.obstacles, scenario.clearance)?;
        for (index, robot) in scenario.robots.iter().enumerate() {
            let inside = |obstacle: &&Obstacle| obstacle.shape.outline().approach(robot.position).gap < 0.0;
            if let Some(obstacle) = scenario.obstacles.iter().find(inside) {
                return Err(ScenarioError::StartInObstacle(index + 1, obstacle.id));
            }
        }
        let count = scenario.robots.len();
        let rest = Steered { acceleration: Vector2::zeros(), lyapunov: 0.0, lyapunov_rate: 0.0 };
        let mut simulation = Self {
            obstacles,
            robots: scenario.robots.clone(),
            seen: scenario.robots.clone(),
            seekers: vec![Seeker::default(); count],
            remedies: vec![Remedy::default(); count],
            deviations: vec![f64::INFINITY; count],
            fragments: Vec::new(),
            steered: vec![rest; count],
            frame: scenario.carriage.at(0.0),
            steps: 0,
            scenario,
        };
        simulation.find_fragments()?;
        Ok(simulation)
    }

    /// Advances by one step.
    ///
    /// # Errors
    /// Robots whose position is no longer finite, where they encroach on the segment.
    pub fn step(&mut self) -> Result<(), ScenarioError> {
        if !self.scenario.carriage.is_parked() {
            self.frame = self.scenario.carriage.at(self.time());
        }
        if self.steps.is_multiple_of(u64::from(self.scenario.steps_per_tick)) {
            self.seen.copy_from_slice(&self.robots);
            let changes = matches!(self.scenario.encroaching, Encroaching::ObstaclesAndRobots(_))
                || !self.scenario.carriage.is_parked();
            if changes {
                self.find_fragments()?;
            }
        }
        for index in 0..self.robots.len() {
            let attracting = self.attract(index);
            self.steered[index] = self.steer(index, attracting);
        }
        for (robot, steered) in self.robots.iter_mut().zip(&self.steered) {
            *robot = robot.advanced_semi_implicit(steered.acceleration, self.scenario.step);
        }
        self.steps += 1;
        Ok(())
    }

    fn steer(&self, index: usize, attracting: Attracting) -> Steered {
        let (scenario, robot) = (&self.scenario, self.robots[index]);
        let ahead = self.seen[..index].iter().enumerate().map(|(other, state)| {
            if other + 1 == index {
                Push::of_leader(&scenario.zoning, robot.position, state.position)
            } else {
                Push::of_robot_ahead(&scenario.zoning, robot.position, state.position)
            }
        });
        let obstacles = self.obstacles.iter().enumerate().map(|(other, obstacle)| {
            let approach = self.remedies[index].approach((other, obstacle), &scenario.obstacles, robot.position);
            Push::of_obstacle(&scenario.potential, approach)
        });
        let leader_velocity = index.checked_sub(1).map(|leader| self.seen[leader].velocity);
        scenario.law.steer(robot, attracting, leader_velocity, ahead.chain(obstacles))
    }
}
