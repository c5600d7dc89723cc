//! What can be seen of a simulated chain.
use super::ChainSimulation;
use crate::Vector2;
use crate::agent::Agent;
use crate::curve::Interval;
use crate::hull::{ApparentObstacle, Obstacle};
use crate::kinematics::PointState;
use crate::laws::Steered;
use crate::trench::Trench;

/// What a robot did at a step: as much of an [`Action`](crate::agent::Action) as is kept of thousands of robots.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Outcome {
    /// What the law said, before limits.
    pub steered: Steered,
    /// Power that what moves around the robot brought into the law's Lyapunov function besides its own rate, m^2/s^3: the sum of
    /// [`Powers`](crate::agent::Powers).
    pub power: f64,
    /// What was applied, within the limits and the safety filter, m/s^2.
    pub acceleration: Vector2<f64>,
    /// Whether limits cut it.
    pub cut: bool,
    /// The point that drew the robot, m; none while its attraction was suspended.
    pub attraction: Option<Vector2<f64>>,
}

impl<T: Trench> ChainSimulation<T> {
    /// Seconds simulated.
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.scenario.step
    }

    /// Robots by rank.
    pub fn robots(&self) -> &[PointState] {
        &self.robots
    }

    /// What each robot did at the last step, by rank; none before the first.
    pub fn outcomes(&self) -> &[Outcome] {
        &self.outcomes
    }

    /// Distances from the points that drew the robots at the last step, m; infinite before any did.
    pub fn deviations(&self) -> &[f64] {
        &self.deviations
    }

    /// Obstacles as they are, at the last tick.
    pub fn real_obstacles(&self) -> &[Obstacle] {
        // What is seen piece by piece rests.
        if self.knowledge.is_some() { &self.scenario.obstacles } else { &self.real }
    }

    /// What robots know of them: all, or the pieces of boundaries that they have seen.
    pub fn known_obstacles(&self) -> &[Obstacle] {
        &self.real
    }

    /// Apparent obstacles.
    pub fn obstacles(&self) -> &[ApparentObstacle] {
        &self.obstacles
    }

    /// The qualified fragments of the robot of a rank (1 is the chain leader).
    pub fn fragments(&self, rank: usize) -> &[Interval] {
        self.agents.get(rank.saturating_sub(1)).map_or(&[], Agent::fragments)
    }

    /// Least gap between the centre of any robot and any real obstacle now, m; infinite without obstacles.
    pub fn least_obstacle_gap(&self) -> f64 {
        let time = self.time();
        let mut least = f64::INFINITY;
        for (obstacle, velocity) in self.scenario.obstacles.iter().zip(self.scenario.velocities()) {
            let outline = obstacle.shape.outline();
            for robot in &self.robots {
                least = least.min(outline.approach(robot.position - time * velocity).gap);
            }
        }
        least
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
