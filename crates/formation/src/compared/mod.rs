//! Obstacle avoidance that 7.8 compares apparent obstacles with, small, for one robot with a goal point among walls: the
//! conventional potential field alone, with Ge and Cui's repulsion, with virtual obstacles, and with instant goals.
mod course;
mod instant_goals;
mod virtual_obstacles;

pub use course::{Course, Outcome, Trip};
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

impl<G: Guide + ?Sized> Guide for &mut G {
    fn target(&mut self, course: &Course, time: f64, robot: Vector2<f64>) -> Vector2<f64> {
        (**self).target(course, time, robot)
    }

    fn repelling(&self) -> &[usize] {
        (**self).repelling()
    }

    fn recoveries(&self) -> u32 {
        (**self).recoveries()
    }
}

/// One of the methods.
#[derive(Debug, Clone, PartialEq)]
pub enum AnyGuide {
    /// See [`Unguided`].
    Unguided,
    /// See [`VirtualObstacles`].
    Virtual(VirtualObstacles),
    /// See [`InstantGoals`].
    Instant(InstantGoals),
}

impl Guide for AnyGuide {
    fn target(&mut self, course: &Course, time: f64, robot: Vector2<f64>) -> Vector2<f64> {
        match self {
            Self::Unguided => course.goal,
            Self::Virtual(guide) => guide.target(course, time, robot),
            Self::Instant(guide) => guide.target(course, time, robot),
        }
    }

    fn repelling(&self) -> &[usize] {
        match self {
            Self::Virtual(guide) => guide.repelling(),
            Self::Unguided | Self::Instant(_) => &[],
        }
    }

    fn recoveries(&self) -> u32 {
        match self {
            Self::Virtual(guide) => guide.recoveries(),
            Self::Unguided | Self::Instant(_) => 0,
        }
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
