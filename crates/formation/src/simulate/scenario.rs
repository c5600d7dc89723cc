//! What is simulated.
use super::Carriage;
use crate::Vector2;
use crate::avoidance::WatchSettings;
use crate::curve::Curve;
use crate::hull::{HullError, Obstacle};
use crate::kinematics::PointState;
use crate::laws::NearestAttraction;
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
    /// Static obstacles, combined below `clearance` before the start.
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
    /// Step of integration, s.
    pub step: f64,
    /// Steps between two samples of what robots know of one another.
    pub steps_per_tick: u32,
}

/// What encroaches on the segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Encroaching {
    /// Nothing: nearest points on the whole segment.
    Nothing,
    /// Apparent obstacles, up to the cut of their potential.
    Obstacles,
    /// Robots ahead too (step (1) of 7.5.2): as obstacles of this radius (m), sought anew at every tick.
    ObstaclesAndRobots(f64),
}

/// Watching for local minima and raising guards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Remedies {
    /// When a robot counts as caught.
    pub watch: WatchSettings,
    /// How fast a guard rises to its place, and how fast robots are led out of hulls, m/s.
    pub rising: f64,
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
    #[error("r{0} starts inside obstacle {1}: move one of them")]
    StartInObstacle(usize, u32),
    /// A goal, pose or velocity of the segment that is NaN or infinite.
    #[error("{0} is not finite: give numbers in SI units")]
    NotFinite(&'static str),
    /// A step or tick that advances nothing.
    #[error("step is {0} s and steps_per_tick is {1}: both must be positive")]
    Step(f64, u32),
    /// See [`HullError`].
    #[error(transparent)]
    Hull(#[from] HullError),
    /// See [`SeekError`].
    #[error(transparent)]
    Seek(#[from] SeekError),
}

impl<T> ChainScenario<T> {
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
        self.seeking.check()?;
        for (index, robot) in self.robots.iter().enumerate() {
            if !finite(robot.position + robot.velocity) {
                return Err(ScenarioError::RobotNotFinite(index + 1));
            }
            for (other_index, other) in self.robots[..index].iter().enumerate() {
                let distance = (robot.position - other.position).norm();
                if distance <= self.zoning.radii().rho_underbar {
                    return Err(ScenarioError::StartInZoneOne(other_index + 1, index + 1, distance));
                }
            }
        }
        Ok(())
    }
}
