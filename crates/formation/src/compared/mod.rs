//! Obstacle avoidance that 7.8 compares apparent obstacles with, small, for one robot with a goal point among walls: the
//! conventional potential field alone, with Ge and Cui's repulsion, with virtual obstacles, and with instant goals.
mod course;
mod instant_goals;
mod virtual_obstacles;

pub use course::{Course, Outcome};
pub use instant_goals::InstantGoals;
pub use virtual_obstacles::VirtualObstacles;

use crate::Vector2;

/// What leads a robot that potentials alone would leave in a local minimum.
pub trait Guide {
    /// Where the attraction pulls now: the goal or a place on the way.
    fn target(&mut self, course: &Course, time: f64, robot: Vector2<f64>) -> Vector2<f64>;

    /// Obstacles (by index) that repel as their convex hulls rather than as their walls.
    fn repelling(&self) -> &[usize] {
        &[]
    }

    /// How often the robot had to be recovered so far.
    fn recoveries(&self) -> u32 {
        0
    }
}

/// No help: conventional potentials, trajectory A of Fig. 7.15.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Unguided;

impl Guide for Unguided {
    fn target(&mut self, course: &Course, _time: f64, _robot: Vector2<f64>) -> Vector2<f64> {
        course.goal
    }
}
