//! Stepping a chain.
use super::sight::Knowledge;
use super::vicinity::Vicinity;
use super::workers::{Alone, Share, Workers};
use super::{ChainScenario, ScenarioError};
use crate::Vector2;
use crate::agent::{Action, Agent, Leader, Surroundings};
use crate::hull::{ApparentObstacle, Obstacle, combine};
use crate::kinematics::PointState;
use crate::laws::RigidMotion;
use crate::trench::Trench;
use nalgebra::Isometry2;
use std::sync::Arc;

/// Robots below which a share is not worth a worker of its own.
const LEAST_SHARE: usize = 128;

/// A chain under way.
#[derive(Debug, Clone)]
pub struct ChainSimulation<T> {
    pub(super) scenario: ChainScenario<T>,
    /// Real obstacles as they are known and apparent ones at the last tick, velocities of the apparent ones.
    pub(super) real: Vec<Obstacle>,
    pub(super) obstacles: Vec<ApparentObstacle>,
    velocities: Vec<Vector2<f64>>,
    /// What the team has seen of obstacles, where it does not know all of them.
    pub(super) knowledge: Option<Knowledge>,
    pub(super) robots: Vec<PointState>,
    /// Robots at the last tick, as others see them.
    seen: Vec<PointState>,
    pub(super) agents: Vec<Agent<T>>,
    /// Distances from the nearest points at the last step, m.
    pub(super) deviations: Vec<f64>,
    seen_deviations: Vec<f64>,
    /// The places that robots had chosen at the last tick, else where they were, m.
    seen_places: Vec<Vector2<f64>>,
    pub(super) actions: Vec<Action>,
    vicinity: Vicinity,
    workers: Arc<dyn Workers + Send + Sync>,
    pub(super) steps: u64,
}

impl<T: Trench + Clone + Send + Sync> ChainSimulation<T> {
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
            knowledge: scenario.options.sight.map(|sight| Knowledge::new(&scenario.obstacles, sight)),
            robots: scenario.robots.clone(),
            seen: scenario.robots.clone(),
            agents: vec![Agent::new(scenario.agent()); count],
            deviations: vec![f64::INFINITY; count],
            seen_deviations: vec![f64::INFINITY; count],
            seen_places: scenario.robots.iter().map(|robot| robot.position).collect(),
            actions: Vec::with_capacity(count),
            vicinity: Vicinity::default(),
            workers: Arc::new(Alone),
            steps: 0,
            scenario,
        };
        simulation.look_round()?;
        simulation.sense()?;
        Ok(simulation)
    }
}

impl<T: Trench + Send + Sync> ChainSimulation<T> {
    /// Advances by one step.
    ///
    /// # Errors
    /// Robots whose position is no longer finite, where they encroach on the segment.
    pub fn step(&mut self) -> Result<(), ScenarioError> {
        self.tick()?;
        let Self { scenario, real, obstacles, velocities, robots, seen, agents, .. } = self;
        let since = (self.steps % u64::from(scenario.steps_per_tick)) as f64 * scenario.step;
        let time = self.steps as f64 * scenario.step - since;
        let view = View {
            scenario,
            time,
            frame: scenario.carriage.at(time),
            real,
            apparent: obstacles,
            velocities,
            seen,
            seen_deviations: &self.seen_deviations,
            seen_places: &self.seen_places,
            vicinity: &self.vicinity,
        };
        self.actions.resize(robots.len(), Action::default());
        // Until the next tick nobody sees what the others do, so the order in which they act, and who works at it, is nothing.
        let size = robots.len().div_ceil(self.workers.count().max(1)).max(LEAST_SHARE);
        if size >= robots.len() {
            view.act(0, agents, robots, since, &mut self.actions);
        } else {
            let team = agents.chunks_mut(size).zip(robots.chunks_mut(size)).zip(self.actions.chunks_mut(size));
            let shares = team.enumerate().map(|(share, ((agents, robots), actions))| -> Share<'_> {
                let view = &view;
                Box::new(move || view.act(share * size, agents, robots, since, actions))
            });
            self.workers.run(shares.collect());
        }
        for (deviation, action) in self.deviations.iter_mut().zip(&self.actions) {
            if action.deviation.is_finite() {
                *deviation = action.deviation;
            }
        }
        self.steps += 1;
        Ok(())
    }

    /// Lets others do the work of the robots' controllers. The motion is the same, bit for bit.
    #[must_use]
    pub fn with(self, workers: impl Workers + Send + Sync + 'static) -> Self {
        Self { workers: Arc::new(workers), ..self }
    }

    /// What happens once a tick.
    fn tick(&mut self) -> Result<(), ScenarioError> {
        if !self.steps.is_multiple_of(u64::from(self.scenario.steps_per_tick)) {
            return Ok(());
        }
        self.seen.copy_from_slice(&self.robots);
        self.seen_deviations.copy_from_slice(&self.deviations);
        for ((seen, robot), action) in self.seen_places.iter_mut().zip(&self.robots).zip(&self.actions) {
            *seen = action.place.unwrap_or(robot.position);
        }
        let moves = self.scenario.moves();
        if moves {
            let time = self.time();
            self.real = self.scenario.obstacles_at(time)?;
            self.obstacles = combine(&self.real, self.scenario.clearance)?;
            self.velocities = self.scenario.velocities_of(&self.obstacles);
        }
        let found = self.look_round()?;
        self.vicinity.look(&self.scenario, &self.seen, &self.real);
        let encroach = self.scenario.encroaching.robot_radius().is_some();
        if moves || found || encroach || !self.scenario.carriage.is_parked() {
            self.sense()?;
        }
        Ok(())
    }

    /// What robots see of obstacles counts from now on; whether that is more than before.
    fn look_round(&mut self) -> Result<bool, ScenarioError> {
        let Some(knowledge) = &mut self.knowledge else { return Ok(false) };
        let found = knowledge.look(&self.seen)?;
        if found || self.steps == 0 {
            self.real = knowledge.known().to_vec();
            self.obstacles = combine(&self.real, self.scenario.clearance)?;
            self.velocities = self.scenario.velocities_of(&self.obstacles);
        }
        Ok(found)
    }

    fn sense(&mut self) -> Result<(), ScenarioError> {
        let Self { scenario, real, obstacles, velocities, seen, agents, .. } = self;
        let time = self.steps as f64 * scenario.step;
        let view = View {
            scenario,
            time,
            frame: scenario.carriage.at(time),
            real,
            apparent: obstacles,
            velocities,
            seen,
            seen_deviations: &self.seen_deviations,
            seen_places: &self.seen_places,
            vicinity: &self.vicinity,
        };
        for (index, agent) in agents.iter_mut().enumerate() {
            agent.sense(&view.around(index))?;
        }
        Ok(())
    }
}

/// What all robots share until the next tick.
struct View<'a, T> {
    scenario: &'a ChainScenario<T>,
    /// Time of the tick, s.
    time: f64,
    /// The segment's frame then.
    frame: (Isometry2<f64>, RigidMotion),
    real: &'a [Obstacle],
    apparent: &'a [ApparentObstacle],
    velocities: &'a [Vector2<f64>],
    seen: &'a [PointState],
    seen_deviations: &'a [f64],
    seen_places: &'a [Vector2<f64>],
    vicinity: &'a Vicinity,
}

impl<T: Trench> View<'_, T> {
    /// One step of the robots from the index `first` on.
    fn act(
        &self,
        first: usize,
        agents: &mut [Agent<T>],
        robots: &mut [PointState],
        since: f64,
        actions: &mut [Action],
    ) {
        let step = self.scenario.step;
        for ((index, done), (agent, robot)) in (first..).zip(actions).zip(agents.iter_mut().zip(robots)) {
            let mut action = agent.act(&self.around(index), *robot, since, step);
            let wanted = action.acceleration;
            action.acceleration = self.vicinity.admit(self.scenario, self.real, (index, *robot), wanted, since);
            *robot = robot.advanced_semi_implicit(action.acceleration, step);
            *done = action;
        }
    }

    /// The surroundings of a robot at the tick.
    fn around(&self, index: usize) -> Surroundings<'_> {
        let (map_from_segment, motion) = self.frame;
        let goal = self.scenario.team_goal.filter(|_| index == 0);
        Surroundings {
            time: self.time,
            curve: &self.scenario.segment,
            map_from_segment,
            motion,
            goal: goal.map(|goal| motion.at(map_from_segment.transform_point(&goal.into()).coords)),
            leader: index
                .checked_sub(1)
                .map(|leader| Leader { state: self.seen[leader], deviation: self.seen_deviations[leader] }),
            ahead: self.vicinity.ahead(self.scenario, self.seen, index),
            places: &self.seen_places[..index],
            behind: self.seen.len() - index - 1,
            real: self.real,
            apparent: self.apparent,
            velocities: self.velocities,
        }
    }
}
