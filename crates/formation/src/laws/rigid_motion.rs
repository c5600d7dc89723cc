//! How the points of a moving segment move.
use super::GoalMotion;
use crate::Vector2;
use nalgebra::{Isometry2, UnitComplex};

/// Motion of a segment's frame, which carries the segment: all in frame `map`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidMotion {
    /// Motion of the frame's origin.
    pub origin: GoalMotion,
    /// Angular velocity, rad/s.
    pub turn_rate: f64,
    /// Angular acceleration, rad/s^2.
    pub turn_acceleration: f64,
}

impl RigidMotion {
    /// A segment that does not move.
    pub fn at_rest() -> Self {
        Self { origin: GoalMotion::at_rest(Vector2::zeros()), turn_rate: 0.0, turn_acceleration: 0.0 }
    }

    /// Whether nothing of it moves now.
    pub fn rests(&self) -> bool {
        self.turn_rate == 0.0 && self.origin.velocity == Vector2::zeros()
    }

    /// The frame's pose and motion after `time` (s) of constant accelerations.
    pub fn carried(&self, pose: Isometry2<f64>, time: f64) -> (Isometry2<f64>, Self) {
        if time == 0.0 {
            return (pose, *self);
        }
        let origin = self.origin.after(time);
        let turned = time * (self.turn_rate + 0.5 * time * self.turn_acceleration);
        let rotation = if turned == 0.0 {
            pose.rotation
        } else {
            let (sine, cosine) = libm::sincos(turned);
            UnitComplex::from_cos_sin_unchecked(cosine, sine) * pose.rotation
        };
        let turn_rate = self.turn_rate + time * self.turn_acceleration;
        let translation = pose.translation.vector + origin.position - self.origin.position;
        (Isometry2::from_parts(translation.into(), rotation), Self { origin, turn_rate, ..*self })
    }

    /// Velocity of the point of the frame that is at `point` now, m/s.
    #[inline]
    pub fn velocity_at(&self, point: Vector2<f64>) -> Vector2<f64> {
        if self.turn_rate == 0.0 {
            return self.origin.velocity;
        }
        let arm = point - self.origin.position;
        self.origin.velocity + self.turn_rate * Vector2::new(-arm.y, arm.x)
    }

    /// Motion of the point of the frame that is at `point` now.
    #[inline]
    pub fn at(&self, point: Vector2<f64>) -> GoalMotion {
        if self.turn_rate == 0.0 && self.turn_acceleration == 0.0 {
            return GoalMotion { position: point, ..self.origin };
        }
        let arm = point - self.origin.position;
        let across = Vector2::new(-arm.y, arm.x);
        GoalMotion {
            position: point,
            velocity: self.velocity_at(point),
            acceleration: self.origin.acceleration + self.turn_acceleration * across
                - self.turn_rate * self.turn_rate * arm,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point of a wheel that rolls at 1 m/s: twice as fast on top, at rest below, and always drawn to the hub.
    #[test]
    fn a_rolling_wheel() {
        let hub = GoalMotion { velocity: Vector2::new(1.0, 0.0), ..GoalMotion::at_rest(Vector2::new(3.0, 2.0)) };
        let wheel = RigidMotion { origin: hub, turn_rate: -0.5, turn_acceleration: 0.25 };
        let (top, bottom) = (wheel.at(Vector2::new(3.0, 4.0)), wheel.at(Vector2::new(3.0, 0.0)));
        assert_eq!((top.velocity, top.acceleration), (Vector2::new(2.0, 0.0), Vector2::new(-0.5, -0.5)));
        assert_eq!((bottom.velocity, bottom.acceleration), (Vector2::new(0.0, 0.0), Vector2::new(0.5, 0.5)));
        assert_eq!(RigidMotion::at_rest().at(Vector2::new(1.0, 2.0)), GoalMotion::at_rest(Vector2::new(1.0, 2.0)));
    }
}
