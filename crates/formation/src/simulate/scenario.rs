//! What is simulated.
use super::sight::{Knowledge, MOST_PIECES};
use super::{BrokenLink, Carriage, Integration, Neighbours, Sight};
use crate::Vector2;
use crate::agent::{AgentSettings, Encroaching, Method, Remedies};
use crate::curve::Curve;
use crate::hull::{ApparentObstacle, HullError, Obstacle, combine_unless};
use crate::kinematics::PointState;
use crate::laws::{Capability, NearestAttraction};
use crate::safety::Stopping;
use crate::seek::{SeekError, SeekSettings};
use crate::zoning::{ObstaclePotential, Zoning};
use thiserror::Error;

/// A chain and its surroundings.
#[derive(Debug, Clone, PartialEq)]
pub struct ChainScenario<T> {
    /// In its own frame.
    pub segment: Curve,
    /// How that frame moves.
    pub carriage: Carriage,
    /// Goal point of the chain leader, in the segment's frame; without it the leader seeks its nearest point.
    pub team_goal: Option<Vector2<f64>>,
    /// Robots by rank at time 0.
    pub robots: Vec<PointState>,
    /// (7.13).
    pub law: NearestAttraction<T>,
    /// Psi to the leader, Psi_hat to all robots ahead.
    pub zoning: Zoning,
    /// Obstacles at time 0, combined below `clearance`; anew at every tick if they move.
    pub obstacles: Vec<Obstacle>,
    /// rho_clearance of (7.8), m.
    pub clearance: f64,
    /// Psi_hat^ob.
    pub potential: ObstaclePotential,
    /// How robots seek their nearest points.
    pub seeking: SeekSettings,
    /// What encroaches on the segment.
    pub encroaching: Encroaching,
    /// How robots get out of local minima; without it they stay.
    pub remedies: Option<Remedies>,
    /// Beyond the thesis.
    pub options: Options,
    /// Step of integration, s.
    pub step: f64,
    /// Steps between two samples of what robots know of one another.
    pub steps_per_tick: u32,
}

/// What a scenario may have besides.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Options {
    /// Which of the laws; (7.13) without it.
    pub method: Option<Method>,
    /// Bounds of speed and acceleration relative to the segment (9.2).
    pub limits: Option<Capability>,
    /// Whether pushes straight against the attraction are turned aside.
    pub sidesteps: bool,
    /// Velocities of the obstacles in order, m/s; those missing rest.
    pub obstacle_velocities: Vec<Vector2<f64>>,
    /// The walls that obstacles in order are pieces of: pieces of one are not combined for adjoining (9.2, Fig. 9.1). Those missing
    /// are of none.
    pub walls: Vec<Option<u32>>,
    /// Whether the law ends in the safety filter. Without it nothing but the law keeps robots apart, as in the thesis.
    pub safety: Option<Stopping>,
    /// The speed (m/s) at which a robot that does not hear its leader, farther off than rho_bar or over a broken link, goes to the segment and
    /// along it towards the team goal, until its leader is in its neutral zone (Remarks 6.2.1 and 8.4.1); without it, or a team goal, such a robot seeks its nearest point alone.
    pub recovery: Option<f64>,
    /// Links that break for a time, by the indices of the followers.
    pub broken: Vec<BrokenLink>,
    /// How far the team sees the boundaries of obstacles, which rest; without it all are known (Remark 7.4.1).
    pub sight: Option<Sight>,
    /// How accelerations, held for a step, become motion. Runge-Kutta would ask robots that remember, and forces that jump,
    /// between two steps: it is refused.
    pub integration: Integration,
}

/// A scenario that cannot be run.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ScenarioError {
    /// No robots.
    #[error("the scenario has no robots: give at least one")]
    NoRobots,
    /// A state that is NaN or infinite.
    #[error("the state of robot r{0} is not finite: give a position in metres and a velocity in m/s")]
    RobotNotFinite(usize),
    /// Two robots that touch at the start.
    #[error("r{0} and r{1} start {2} m apart, within zone 1 of each other: move one of them")]
    StartInZoneOne(usize, usize, f64),
    /// A robot that starts in an obstacle (to start in the hull of several is permitted).
    #[error("r{0} starts inside obstacle {1}, or touches it: move one of them")]
    StartInObstacle(usize, u32),
    /// A robot whose body overlaps an obstacle at the start, by so much, m.
    #[error("the body of r{0} reaches {2:.4} m into obstacle {1} at the start: move one of them")]
    BodyInObstacle(usize, u32, f64),
    /// Two robots whose bodies overlap at the start, their distance and that at which they touch, m.
    #[error("r{0} and r{1} start {2} m apart, but two bodies need {3} m: move one of them")]
    BodiesOverlap(usize, usize, f64, f64),
    /// A goal, pose or velocity of the segment that is NaN or infinite.
    #[error("{0} is not finite: give numbers in SI units")]
    NotFinite(&'static str),
    /// A step or tick that advances nothing.
    #[error("step is {0} s and steps_per_tick is {1}: both must be positive")]
    Step(f64, u32),
    /// A method of integration that does not suit the chain.
    #[error("{0:?} does not suit {1}: take another method")]
    Integration(Integration, &'static str),
    /// Boundaries that are seen in pieces of their own, of walls in pieces.
    #[error("pieces of a wall cannot be seen piece by piece: let them be combined, or have all boundaries known")]
    SightOfWalls,
    /// Boundaries that are seen piece by piece while their obstacle moves.
    #[error("obstacles that move cannot be seen piece by piece: let them rest, or have all boundaries known")]
    SightOfMoving,
    /// A sight, m, in which boundaries come when they are nearer than their potential reaches, m.
    #[error(
        "a robot sees pieces of boundaries by their middles, and some not before they repel it: within {reach:.4} m, from where it can be {needed:.4} m to a middle"
    )]
    SightTooShort {
        /// Of the potential.
        reach: f64,
        /// The range that suffices.
        needed: f64,
    },
    /// Boundaries in more pieces than can be looked at.
    #[error("pieces of {0} m cut the boundaries of the obstacles into more than {MOST_PIECES:.0}")]
    SightTooFine(f64),
    /// See [`HullError`].
    #[error(transparent)]
    Hull(#[from] HullError),
    /// See [`SeekError`].
    #[error(transparent)]
    Seek(#[from] SeekError),
}

impl<T: Clone> ChainScenario<T> {
    /// What a team knows of its obstacles at the start.
    pub(super) fn knowledge(&self, sight: Sight) -> Result<Knowledge, ScenarioError> {
        let reach = self.potential.cut();
        let needed = libm::hypot(reach, 0.5 * sight.piece);
        if sight.range < needed {
            return Err(ScenarioError::SightTooShort { reach, needed });
        }
        Knowledge::new(&self.obstacles, sight).ok_or(ScenarioError::SightTooFine(sight.piece))
    }

    /// The controller that every robot gets.
    pub fn agent(&self) -> AgentSettings<T> {
        AgentSettings {
            law: self.law.clone(),
            method: self.options.method.unwrap_or(Method::Nearest),
            zoning: self.zoning,
            potential: self.potential,
            clearance: self.clearance,
            seeking: self.seeking,
            encroaching: self.encroaching,
            remedies: self.remedies,
            limits: self.options.limits,
            sidesteps: self.options.sidesteps,
        }
    }
}

impl<T> ChainScenario<T> {
    /// What obstacles that are among those of the scenario, wherever they are by now, are combined to (7.8).
    ///
    /// # Errors
    /// See [`combine`](crate::hull::combine).
    pub fn combined(&self, obstacles: &[Obstacle]) -> Result<Vec<ApparentObstacle>, HullError> {
        let pieces = || self.obstacles.iter().zip(&self.options.walls);
        let wall = |id: u32| pieces().find(|(piece, _)| piece.id == id).and_then(|(_, wall)| *wall);
        combine_unless(obstacles, self.clearance, |a, b| wall(a).is_some_and(|of| wall(b) == Some(of)))
    }

    /// Of the robots' bodies, m, by the safety filter or else by what encroaches; none where neither names one.
    pub fn body_radius(&self) -> Option<f64> {
        self.options.safety.map(|safety| safety.radius).or(self.encroaching.robot_radius())
    }

    /// Whether any obstacle moves.
    pub fn moves(&self) -> bool {
        self.options.obstacle_velocities.iter().any(|velocity| *velocity != Vector2::zeros())
    }

    /// Velocities of the obstacles in order, without end, m/s.
    pub(super) fn velocities(&self) -> impl Iterator<Item = Vector2<f64>> + Clone + '_ {
        self.options.obstacle_velocities.iter().copied().chain(core::iter::repeat(Vector2::zeros()))
    }

    /// The obstacles at `time` (s).
    ///
    /// # Errors
    /// Ways beyond all numbers.
    pub fn obstacles_at(&self, time: f64) -> Result<Vec<Obstacle>, ScenarioError> {
        let moved = |(obstacle, velocity): (&Obstacle, Vector2<f64>)| {
            Ok(Obstacle { id: obstacle.id, shape: obstacle.shape.moved(time * velocity)? })
        };
        self.obstacles.iter().zip(self.velocities()).map(moved).collect()
    }

    /// Velocities of apparent obstacles: each that of its fastest member, m/s.
    pub(super) fn velocities_of(&self, apparent: &[ApparentObstacle]) -> Vec<Vector2<f64>> {
        let velocities = &self.options.obstacle_velocities;
        let of = |obstacle: &ApparentObstacle| {
            let members = self.obstacles.iter().zip(velocities).filter(|(real, _)| obstacle.members.contains(&real.id));
            let faster = |a: Vector2<f64>, b: &Vector2<f64>| if b.norm_squared() > a.norm_squared() { *b } else { a };
            members.map(|(_, velocity)| velocity).fold(Vector2::zeros(), faster)
        };
        apparent.iter().map(of).collect()
    }

    /// What can be said before obstacles are combined.
    pub(super) fn check(&self) -> Result<(), ScenarioError> {
        let finite = |vector: Vector2<f64>| vector.x.is_finite() && vector.y.is_finite();
        let carriage = &self.carriage;
        if self.robots.is_empty() {
            return Err(ScenarioError::NoRobots);
        }
        if !(self.step.is_finite() && self.step > 0.0 && self.steps_per_tick > 0) {
            return Err(ScenarioError::Step(self.step, self.steps_per_tick));
        }
        if !(finite(carriage.origin + carriage.velocity) && (carriage.heading + carriage.turn_rate).is_finite()) {
            return Err(ScenarioError::NotFinite("the motion of the segment"));
        }
        if !self.team_goal.is_none_or(finite) {
            return Err(ScenarioError::NotFinite("the team goal"));
        }
        if !self.options.obstacle_velocities.iter().copied().all(finite) {
            return Err(ScenarioError::NotFinite("the velocity of an obstacle"));
        }
        match (self.options.integration, self.options.safety) {
            (Integration::RungeKutta, _) => {
                let what = "forces that jump at obstacles, nor robots that remember";
                return Err(ScenarioError::Integration(Integration::RungeKutta, what));
            }
            (Integration::Exact, Some(_)) => {
                let what = "the safety filter, whose room is that of semi-implicit steps";
                return Err(ScenarioError::Integration(Integration::Exact, what));
            }
            _ => {}
        }
        self.seeking.check()?;
        if self.options.sight.is_some() && self.moves() {
            return Err(ScenarioError::SightOfMoving);
        }
        if self.options.sight.is_some() && self.options.walls.iter().any(Option::is_some) {
            return Err(ScenarioError::SightOfWalls);
        }
        if let Some(index) = self.robots.iter().position(|robot| !finite(robot.position + robot.velocity)) {
            return Err(ScenarioError::RobotNotFinite(index + 1));
        }
        let (near, touch) = (self.zoning.radii().rho_underbar, 2.0 * self.body_radius().unwrap_or(0.0));
        let mut neighbours = Neighbours::default();
        neighbours.update(near.max(touch), &self.robots, &[]);
        for (index, robot) in self.robots.iter().enumerate() {
            for &other in neighbours.of(index).iter().take_while(|other| (**other as usize) < index) {
                let distance = (robot.position - self.robots[other as usize].position).norm();
                if distance <= near {
                    return Err(ScenarioError::StartInZoneOne(other as usize + 1, index + 1, distance));
                }
                if distance < touch {
                    return Err(ScenarioError::BodiesOverlap(other as usize + 1, index + 1, distance, touch));
                }
            }
        }
        Ok(())
    }
}
