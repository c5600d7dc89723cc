//! The frame of a formation: where it is and how it moves.

use crate::virtual_point::VirtualPoint;
use trench_formation::Vector2;
use trench_formation::laws::GoalMotion;
use trench_msgs::msg::{FrameMotion, Point2};

/// Where the formation's frame is and how it moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Carrier {
    /// Position of its origin, m, map.
    pub position: Vector2<f64>,
    /// Its direction, rad.
    pub theta: f64,
    /// m/s, map.
    pub velocity: Vector2<f64>,
    /// m/s^2, map.
    pub acceleration: Vector2<f64>,
    /// rad/s.
    pub omega: f64,
}

impl Carrier {
    /// The map itself.
    pub const MAP: Self = Self {
        position: Vector2::new(0.0, 0.0),
        theta: 0.0,
        velocity: Vector2::new(0.0, 0.0),
        acceleration: Vector2::new(0.0, 0.0),
        omega: 0.0,
    };

    /// A body that keeps its twist: its velocity turns with it. With `turns` false the frame's axes stay those of the map.
    #[must_use]
    pub fn moving(position: Vector2<f64>, theta: f64, velocity: Vector2<f64>, omega: f64, turns: bool) -> Self {
        let acceleration = omega * left(velocity);
        let (theta, omega) = if turns { (theta, omega) } else { (0.0, 0.0) };
        Self { position, theta, velocity, acceleration, omega }
    }

    /// The frame `seconds` later if its acceleration and turn rate last.
    #[must_use]
    pub fn after(&self, seconds: f64) -> Self {
        Self {
            position: self.position + seconds * self.velocity + 0.5 * seconds * seconds * self.acceleration,
            theta: self.theta + seconds * self.omega,
            velocity: self.velocity + seconds * self.acceleration,
            ..*self
        }
    }

    /// A point of the map as the formation's frame sees it.
    #[must_use]
    pub fn from_map(&self, point: Vector2<f64>) -> Vector2<f64> {
        rotated(point - self.position, -self.theta)
    }

    /// A point of the formation's frame as the map sees it.
    #[must_use]
    pub fn to_map(&self, point: Vector2<f64>) -> Vector2<f64> {
        self.position + rotated(point, self.theta)
    }

    /// The message about it.
    #[must_use]
    pub fn message(&self) -> FrameMotion {
        FrameMotion {
            position: to_message(self.position),
            theta: self.theta,
            velocity: to_message(self.velocity),
            acceleration: to_message(self.acceleration),
            turn_rate: self.omega,
        }
    }
}

impl VirtualPoint {
    /// The point in the map, carried along by the formation's frame: its own motion, the frame's, and Coriolis'.
    #[must_use]
    pub fn carried(self, by: &Carrier) -> Self {
        if *by == Carrier::MAP {
            return self;
        }
        let arm = rotated(self.motion.position, by.theta);
        let own = rotated(self.motion.velocity, by.theta);
        let motion = GoalMotion {
            position: by.position + arm,
            velocity: by.velocity + by.omega * left(arm) + own,
            acceleration: by.acceleration + rotated(self.motion.acceleration, by.theta) + 2.0 * by.omega * left(own)
                - by.omega * by.omega * arm,
        };
        Self { motion, ..self }
    }
}

/// A vector as a point of a message.
pub(crate) fn to_message(vector: Vector2<f64>) -> Point2 {
    Point2 { x: vector.x, y: vector.y }
}

fn rotated(vector: Vector2<f64>, angle: f64) -> Vector2<f64> {
    let (sin, cos) = libm::sincos(angle);
    Vector2::new(cos * vector.x - sin * vector.y, sin * vector.x + cos * vector.y)
}

fn left(vector: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-vector.y, vector.x)
}
