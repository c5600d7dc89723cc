//! Stepping a chain.
use super::remedy::{Asked, Drawn, Remedy, Surroundings};
use super::{ChainScenario, Encroaching, ScenarioError};
use crate::Vector2;
use crate::curve::{Interval, Placed};
use crate::hull::{ApparentObstacle, Obstacle, Outline, combine};
use crate::kinematics::PointState;
use crate::laws::{Attracting, GoalMotion, Push, RigidMotion, Steered};
use crate::seek::{Fragments, LeaderView, Seeker, Sought, apparent_obstacles};
use crate::trench::Trench;
use nalgebra::Isometry2;

/// A chain under way.
#[derive(Debug, Clone)]
pub struct ChainSimulation<T> {
    scenario: ChainScenario<T>,
    obstacles: Vec<ApparentObstacle>,
    robots: Vec<PointState>,
    /// Robots at the last tick, as others see them.
    seen: Vec<PointState>,
    seekers: Vec<Seeker>,
    remedies: Vec<Remedy>,
    /// Distances from the nearest points at the last step, m.
    deviations: Vec<f64>,
    /// Fragments of each robot, or one for all.
    fragments: Vec<Fragments>,
    steered: Vec<Steered>,
    frame: (Isometry2<f64>, RigidMotion),
    steps: u64,
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

    /// What draws a robot: its goal or nearest point, unless a remedy asks for something else.
    fn attract(&mut self, index: usize) -> Attracting {
        let (map_from_segment, motion) = self.frame;
        let robot = self.robots[index].position;
        let goal = self.scenario.team_goal.filter(|_| index == 0);
        let drawn = match goal.map(|goal| map_from_segment.transform_point(&goal.into()).coords) {
            Some(goal) => Drawn::Goal(goal),
            None => match self.seek(index) {
                Sought::Point(foot) => Drawn::To(foot),
                Sought::Tie | Sought::NoFragment => return Attracting { foot: motion.at(robot), draws: false },
            },
        };
        let target = match drawn {
            Drawn::Goal(goal) => goal,
            Drawn::To(foot) => foot.point,
        };
        self.deviations[index] = (target - robot).norm();
        match self.remedy(index, drawn) {
            Asked::Attraction => Attracting { foot: motion.at(target), draws: true },
            Asked::Suspension => Attracting { foot: motion.at(robot), draws: false },
            Asked::Point(point) => Attracting { foot: GoalMotion::at_rest(point), draws: true },
        }
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

    fn remedy(&mut self, index: usize, drawn: Drawn) -> Asked {
        let scenario = &self.scenario;
        let Some(remedies) = &scenario.remedies else { return Asked::Attraction };
        let around = Surroundings {
            remedies,
            time: self.steps as f64 * scenario.step,
            step: scenario.step,
            segment: Placed::new(&scenario.segment, self.frame.0),
            real: &scenario.obstacles,
            apparent: &self.obstacles,
            potential: &scenario.potential,
        };
        self.remedies[index].update(&around, self.robots[index].position, drawn)
    }

    fn seek(&mut self, index: usize) -> Sought {
        let scenario = &self.scenario;
        let segment = Placed::new(&scenario.segment, self.frame.0);
        let leader = index.checked_sub(1).map(|leader| {
            let state = self.seen[leader];
            let speed = (state.velocity - self.frame.1.at(state.position).velocity).norm();
            let view = LeaderView { position: state.position, distance: self.deviations[leader], speed };
            (view, scenario.zoning.radii())
        });
        let whole = (0.0, scenario.segment.length());
        let fragments = &self.fragments[index.min(self.fragments.len() - 1)];
        self.seekers[index].seek(&scenario.seeking, &segment, (whole, fragments), self.robots[index].position, leader)
    }

    fn find_fragments(&mut self) -> Result<(), ScenarioError> {
        let scenario = &self.scenario;
        let whole = (0.0, scenario.segment.length());
        let segment = Placed::new(&scenario.segment, self.frame.0);
        let find = |obstacles: &[ApparentObstacle]| {
            let outlines: Vec<Outline<'_>> = obstacles.iter().map(|obstacle| obstacle.shape.outline()).collect();
            Fragments::find(&segment, whole, &outlines, scenario.potential.cut(), scenario.seeking.room)
        };
        self.fragments = match scenario.encroaching {
            Encroaching::Nothing => vec![Fragments::whole(whole)],
            Encroaching::Obstacles => vec![find(&self.obstacles)],
            Encroaching::ObstaclesAndRobots(radius) => {
                let positions: Vec<Vector2<f64>> = self.seen.iter().map(|state| state.position).collect();
                let of_robot = |index: usize| {
                    apparent_obstacles(&scenario.obstacles, &positions[..index], radius, scenario.clearance)
                };
                (0..positions.len()).map(|index| Ok(find(&of_robot(index)?))).collect::<Result<_, ScenarioError>>()?
            }
        };
        Ok(())
    }

    /// Seconds simulated.
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.scenario.step
    }

    /// Robots by rank.
    pub fn robots(&self) -> &[PointState] {
        &self.robots
    }

    /// What the law said at the last step, by rank.
    pub fn steered(&self) -> &[Steered] {
        &self.steered
    }

    /// Distances from the points that drew the robots at the last step, m; infinite before any did.
    pub fn deviations(&self) -> &[f64] {
        &self.deviations
    }

    /// Apparent obstacles.
    pub fn obstacles(&self) -> &[ApparentObstacle] {
        &self.obstacles
    }

    /// The qualified fragments of the robot of a rank (1 is the chain leader).
    pub fn fragments(&self, rank: usize) -> &[Interval] {
        self.fragments[rank.saturating_sub(1).min(self.fragments.len() - 1)].intervals()
    }

    /// Least distance between any two robots now, m.
    pub fn least_distance(&self) -> f64 {
        let mut least = f64::INFINITY;
        for (index, robot) in self.robots.iter().enumerate() {
            for other in &self.robots[..index] {
                least = least.min((robot.position - other.position).norm_squared());
            }
        }
        least.sqrt()
    }
}
