//! How a segment moves during a simulation.
use crate::Vector2;
use crate::laws::{GoalMotion, RigidMotion};
use nalgebra::{Isometry2, UnitComplex};

/// A frame that moves steadily: its origin on a line, while it turns about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Carriage {
    /// Origin at time 0, m, frame `map`.
    pub origin: Vector2<f64>,
    /// Direction of its x axis at time 0, rad.
    pub heading: f64,
    /// m/s.
    pub velocity: Vector2<f64>,
    /// rad/s.
    pub turn_rate: f64,
}

impl Carriage {
    /// The frame `map` itself.
    pub fn parked() -> Self {
        Self { origin: Vector2::zeros(), heading: 0.0, velocity: Vector2::zeros(), turn_rate: 0.0 }
    }

    /// Whether it never moves.
    pub fn is_parked(&self) -> bool {
        self.velocity == Vector2::zeros() && self.turn_rate == 0.0
    }

    /// Transform to `map` and motion of the frame at `time` (s).
    pub fn at(&self, time: f64) -> (Isometry2<f64>, RigidMotion) {
        let origin = self.origin + time * self.velocity;
        let (sine, cosine) = libm::sincos(self.heading + time * self.turn_rate);
        let rotation = UnitComplex::from_cos_sin_unchecked(cosine, sine);
        let goal = GoalMotion { position: origin, velocity: self.velocity, acceleration: Vector2::zeros() };
        let motion = RigidMotion { origin: goal, turn_rate: self.turn_rate, turn_acceleration: 0.0 };
        (Isometry2::from_parts(origin.into(), rotation), motion)
    }
}
