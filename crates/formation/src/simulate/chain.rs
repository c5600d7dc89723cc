//! Stepping a chain.
use super::{ChainScenario, Encroaching, ScenarioError};
use crate::Vector2;
use crate::agent::{Action, Agent, Leader, Surroundings};
use crate::hull::{ApparentObstacle, Obstacle, combine};
use crate::kinematics::PointState;
use crate::trench::Trench;

/// A chain under way.
#[derive(Debug, Clone)]
pub struct ChainSimulation<T> {
    pub(super) scenario: ChainScenario<T>,
    /// Real and apparent obstacles at the last tick, velocities of the apparent ones.
    pub(super) real: Vec<Obstacle>,
    pub(super) obstacles: Vec<ApparentObstacle>,
    velocities: Vec<Vector2<f64>>,
    pub(super) robots: Vec<PointState>,
    /// Robots at the last tick, as others see them.
    seen: Vec<PointState>,
    pub(super) agents: Vec<Agent<T>>,
    /// Distances from the nearest points at the last step, m.
    pub(super) deviations: Vec<f64>,
    seen_deviations: Vec<f64>,
    pub(super) actions: Vec<Action>,
    pub(super) steps: u64,
}

impl<T: Trench + Clone> ChainSimulation<T> {
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
        let mut simulation = Self {
            real: scenario.obstacles.clone(),
            velocities: scenario.velocities_of(&obstacles),
            obstacles,
            robots: scenario.robots.clone(),
            seen: scenario.robots.clone(),
            agents: vec![Agent::new(scenario.agent()); count],
            deviations: vec![f64::INFINITY; count],
            seen_deviations: vec![f64::INFINITY; count],
            actions: Vec::with_capacity(count),
            steps: 0,
            scenario,
        };
        simulation.sense()?;
        Ok(simulation)
    }
}

impl<T: Trench> ChainSimulation<T> {
    /// Advances by one step.
    ///
    /// # Errors
    /// Robots whose position is no longer finite, where they encroach on the segment.
    pub fn step(&mut self) -> Result<(), ScenarioError> {
        let ticks = u64::from(self.scenario.steps_per_tick);
        if self.steps.is_multiple_of(ticks) {
            self.seen.copy_from_slice(&self.robots);
            self.seen_deviations.copy_from_slice(&self.deviations);
            let moves = self.scenario.moves();
            if moves {
                let time = self.time();
                self.real = self.scenario.obstacles_at(time)?;
                self.obstacles = combine(&self.real, self.scenario.clearance)?;
                self.velocities = self.scenario.velocities_of(&self.obstacles);
            }
            let encroach = matches!(self.scenario.encroaching, Encroaching::ObstaclesAndRobots(_));
            if moves || encroach || !self.scenario.carriage.is_parked() {
                self.sense()?;
            }
        }
        let step = self.scenario.step;
        let since = (self.steps % ticks) as f64 * step;
        self.actions.clear();
        for index in 0..self.robots.len() {
            let action = self.with_surroundings(index, |agent, around, robot| agent.act(around, robot, since, step));
            if action.deviation.is_finite() {
                self.deviations[index] = action.deviation;
            }
            self.actions.push(action);
        }
        for (robot, action) in self.robots.iter_mut().zip(&self.actions) {
            *robot = robot.advanced_semi_implicit(action.acceleration, step);
        }
        self.steps += 1;
        Ok(())
    }

    /// Time of the tick in force, s: that of the last step.
    fn tick_time(&self) -> f64 {
        (self.steps - self.steps % u64::from(self.scenario.steps_per_tick)) as f64 * self.scenario.step
    }

    fn sense(&mut self) -> Result<(), ScenarioError> {
        for index in 0..self.robots.len() {
            self.with_surroundings(index, |agent, around, _| agent.sense(around))?;
        }
        Ok(())
    }

    /// Calls `work` with a robot's controller, its surroundings at the last tick, and its state now.
    fn with_surroundings<R>(
        &mut self,
        index: usize,
        work: impl FnOnce(&mut Agent<T>, &Surroundings<'_>, PointState) -> R,
    ) -> R {
        let scenario = &self.scenario;
        let time = self.tick_time();
        let (map_from_segment, motion) = scenario.carriage.at(time);
        let goal = scenario.team_goal.filter(|_| index == 0);
        let around = Surroundings {
            time,
            curve: &scenario.segment,
            map_from_segment,
            motion,
            goal: goal.map(|goal| motion.at(map_from_segment.transform_point(&goal.into()).coords)),
            leader: index
                .checked_sub(1)
                .map(|leader| Leader { state: self.seen[leader], deviation: self.seen_deviations[leader] }),
            ahead: &self.seen[..index.saturating_sub(1)],
            real: &self.real,
            apparent: &self.obstacles,
            velocities: &self.velocities,
        };
        work(&mut self.agents[index], &around, self.robots[index])
    }
}
