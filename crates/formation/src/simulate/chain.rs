//! Stepping a chain.
use super::act::{Part, View};
use super::links::Links;
use super::sight::Knowledge;
use super::vicinity::Vicinity;
use super::workers::{Alone, Share, Workers};
use super::{ChainScenario, Outcome, QueueChange, ScenarioError};
use crate::Vector2;
use crate::agent::Agent;
use crate::hull::{ApparentObstacle, Obstacle};
use crate::kinematics::PointState;
use crate::trench::Trench;
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
    /// The places that robots have chosen, and had at the last tick, else where they are or were, m: where somebody asks for them.
    places: Vec<Vector2<f64>>,
    seen_places: Vec<Vector2<f64>>,
    pub(super) outcomes: Vec<Outcome>,
    vicinity: Vicinity,
    links: Links,
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
        let obstacles = scenario.combined(&scenario.obstacles)?;
        for (index, robot) in scenario.robots.iter().enumerate() {
            for obstacle in &scenario.obstacles {
                let gap = obstacle.shape.outline().approach(robot.position).gap;
                let reach = scenario.body_radius().unwrap_or(0.0) - gap;
                if gap <= 0.0 {
                    return Err(ScenarioError::StartInObstacle(index + 1, obstacle.id));
                }
                if reach > 0.0 {
                    return Err(ScenarioError::BodyInObstacle(index + 1, obstacle.id, reach));
                }
            }
        }
        let count = scenario.robots.len();
        let mut simulation = Self {
            real: scenario.obstacles.clone(),
            velocities: scenario.velocities_of(&obstacles),
            obstacles,
            knowledge: scenario.options.sight.map(|sight| scenario.knowledge(sight)).transpose()?,
            robots: scenario.robots.clone(),
            seen: scenario.robots.clone(),
            agents: vec![Agent::new(scenario.agent()); count],
            deviations: vec![f64::INFINITY; count],
            seen_deviations: vec![f64::INFINITY; count],
            places: scenario.robots.iter().map(|robot| robot.position).collect(),
            seen_places: scenario.robots.iter().map(|robot| robot.position).collect(),
            outcomes: Vec::with_capacity(count),
            vicinity: Vicinity::default(),
            links: Links::default(),
            workers: Arc::new(Alone),
            steps: 0,
            scenario,
        };
        simulation.look_round()?;
        simulation.look_for_links();
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
        self.outcomes.resize(self.robots.len(), Outcome::default());
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
            links: &self.links,
        };
        // Until the next tick nobody sees what the others do, so the order in which they act, and who works at it, is nothing.
        let size = robots.len().div_ceil(self.workers.count().max(1)).max(LEAST_SHARE);
        let outcomes =
            self.outcomes.chunks_mut(size).zip(self.deviations.chunks_mut(size)).zip(self.places.chunks_mut(size));
        let parts = agents.chunks_mut(size).zip(robots.chunks_mut(size)).zip(outcomes).enumerate();
        let parts = parts.map(|(share, ((agents, robots), ((outcomes, deviations), places)))| Part {
            first: share * size,
            agents,
            robots,
            outcomes,
            deviations,
            places,
        });
        if size >= view.seen.len() {
            parts.for_each(|part| view.act(since, part));
        } else {
            let view = &view;
            let shares = parts.map(|part| -> Share<'_> { Box::new(move || view.act(since, part)) });
            self.workers.run(shares.collect());
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
        self.look_for_links();
        if self.scenario.encroaching.tells_places() {
            self.seen_places.copy_from_slice(&self.places);
        } else if self.scenario.remedies.is_some() {
            // Nobody has chosen a place: each is where it is, for those who look for one.
            let seen = self.seen_places.iter_mut().zip(&self.seen);
            seen.for_each(|(place, robot)| *place = robot.position);
        }
        let moves = self.scenario.moves();
        if moves {
            let time = self.time();
            self.real = self.scenario.obstacles_at(time)?;
            self.obstacles = self.scenario.combined(&self.real)?;
            self.velocities = self.scenario.velocities_of(&self.obstacles);
        }
        let found = self.look_round()?;
        if found {
            self.vicinity.forget();
        }
        self.vicinity.look(&self.scenario, &self.seen, (&self.real, &self.obstacles), &self.links);
        let encroach = self.scenario.encroaching.robot_radius().is_some();
        if moves || found || encroach || !self.scenario.carriage.is_parked() {
            self.sense()?;
        }
        Ok(())
    }

    /// Who hears whom until the next tick.
    fn look_for_links(&mut self) {
        let (time, radii, options) = (self.time(), self.scenario.zoning.radii(), &self.scenario.options);
        // Who comes to its leader by itself follows it from where the margin of the link, zone 5, is behind it: it hears it for long then.
        let back = options.recovery.map_or(radii.rho_bar, |_| radii.rho_check);
        self.links.look(time, &self.seen, (radii.rho_bar, back), &options.broken);
    }

    /// What befell the links between robots and their leaders so far, in time.
    pub fn changes(&self) -> &[QueueChange] {
        self.links.changes()
    }

    /// What robots see of obstacles counts from now on; whether that is more than before.
    fn look_round(&mut self) -> Result<bool, ScenarioError> {
        let Some(knowledge) = &mut self.knowledge else { return Ok(false) };
        let found = knowledge.look(&self.seen)?;
        if found || self.steps == 0 {
            self.real = knowledge.known().to_vec();
            self.obstacles = self.scenario.combined(&self.real)?;
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
            links: &self.links,
        };
        let Some((first, others)) = agents.split_first_mut() else { return Ok(()) };
        let mut around = view.around(0);
        first.sense(&around)?;
        let alike = scenario.encroaching.robot_radius().is_none();
        let mut ahead: &Agent<T> = first;
        for (agent, index) in others.iter_mut().zip(1..) {
            view.stand_at(&mut around, index);
            match alike {
                true => agent.sense_as(ahead, &around),
                false => agent.sense_behind(ahead, &around)?,
            }
            ahead = agent;
        }
        Ok(())
    }
}
