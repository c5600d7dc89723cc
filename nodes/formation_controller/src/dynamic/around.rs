//! What a law looks at in one tick, and how it moves on until the next.

use nalgebra::{Isometry2, UnitComplex};
use trench_formation::Vector2;
use trench_formation::curve::Curve;
use trench_formation::hull::{Approach, Shape};
use trench_formation::kinematics::PointState;
use trench_formation::laws::{GoalMotion, RigidMotion};
use trench_formation::seek::Fragments;

/// The formation's frame at the beginning of the tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Frame {
    pub(crate) origin: GoalMotion,
    pub(crate) theta: f64,
    pub(crate) turn_rate: f64,
}

impl Frame {
    /// The frame after `time` seconds.
    pub(crate) fn after(&self, time: f64) -> Self {
        let Self { origin, theta, turn_rate } = *self;
        Self { origin: moved(origin, time), theta: theta + time * turn_rate, turn_rate }
    }

    pub(crate) fn motion(&self) -> RigidMotion {
        RigidMotion { origin: self.origin, turn_rate: self.turn_rate, turn_acceleration: 0.0 }
    }

    pub(crate) fn map_from_segment(&self) -> Isometry2<f64> {
        let (sine, cosine) = libm::sincos(self.theta);
        Isometry2::from_parts(self.origin.position.into(), UnitComplex::from_cos_sin_unchecked(cosine, sine))
    }
}

/// A point after `time` seconds of constant acceleration.
pub(crate) fn moved(point: GoalMotion, time: f64) -> GoalMotion {
    GoalMotion {
        position: point.position + time * point.velocity + 0.5 * time * time * point.acceleration,
        velocity: point.velocity + time * point.acceleration,
        acceleration: point.acceleration,
    }
}

/// A robot ahead in the chain, at the beginning of the tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ahead {
    /// The point that it steers.
    pub(crate) state: PointState,
    /// m, from what draws it.
    pub(crate) deviation: f64,
}

/// An apparent obstacle.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MovingHull {
    pub(crate) shape: Shape,
    pub(crate) velocity: Vector2<f64>,
}

impl MovingHull {
    /// Distance and direction from `point`, `time` seconds after the beginning of the tick.
    pub(crate) fn approach(&self, point: Vector2<f64>, time: f64) -> Approach {
        self.shape.outline().approach(point - time * self.velocity)
    }
}

/// Everything that a law looks at.
pub(crate) struct Around<'a> {
    /// The robot's goal point.
    pub(crate) goal: GoalMotion,
    pub(crate) frame: Frame,
    pub(crate) segment: Option<&'a Curve>,
    pub(crate) rank: u32,
    /// The robots ahead, the leader last.
    pub(crate) ahead: &'a [Ahead],
    pub(crate) hulls: &'a [MovingHull],
    /// The robot's qualified fragments of the segment.
    pub(crate) fragments: &'a Fragments,
}
