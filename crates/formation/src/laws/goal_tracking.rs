//! Laws (5.1), (5.2) and (5.3): a double integrator in a trench around its goal point.
use super::{GoalMotion, Terms};
use crate::Vector2;
use crate::kinematics::PointState;
use crate::lanes::{Number, Plane};
use crate::trench::{ConstantDamping, Damping, Hyperbolic, Trench};

/// u = r_g'' + k(d) d' + Phi'(d) d_hat, d from the robot to the goal point.
///
/// (5.1) is the law with [`ConstantDamping`](crate::trench::ConstantDamping), (5.2) with K' = k(d), (5.3) is (5.1) for a
/// goal point at rest. With V = |d'|^2/2 + Phi(d), V' = -k |d'|^2 (A.5, A.10): every admissible trench will do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GoalTracking<T, D> {
    /// Phi.
    pub trench: T,
    /// k, or K' of (5.2).
    pub damping: D,
}

/// What a law for double integrators says.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Steered {
    /// u, m/s^2, frame `map`.
    pub acceleration: Vector2<f64>,
    /// The Lyapunov function of the law, m^2/s^2.
    pub lyapunov: f64,
    /// Its derivative while what the robot follows moves as the law assumes.
    pub lyapunov_rate: f64,
}

/// What a robot can do, beyond what its goal point does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capability {
    /// m/s, positive.
    pub speed: f64,
    /// m/s^2, positive.
    pub acceleration: f64,
}

impl Capability {
    /// The part of the acceleration `wanted` that a robot can follow for `step` (s) at `velocity`: not longer than the acceleration,
    /// and none that makes it faster than the speed. A robot that is too fast already brakes as it can.
    pub fn admit(&self, velocity: Vector2<f64>, wanted: Vector2<f64>, step: f64) -> Vector2<f64> {
        let cut = wanted.cap_magnitude(self.acceleration);
        let next = velocity + step * cut;
        if next.norm() <= self.speed {
            return cut;
        }
        ((next.cap_magnitude(self.speed) - velocity) / step).cap_magnitude(self.acceleration)
    }
}

impl GoalTracking<Hyperbolic, ConstantDamping> {
    /// (5.1) for a bounded actuator (9.2): Phi = alpha (sqrt(x^2 + a^2) - a) with alpha half of the acceleration and k = alpha
    /// over the speed.
    ///
    /// |d'|' <= -k |d'| + alpha, so |d'| never exceeds the speed once it is below it, and |u - r_g''| <= k |d'| + alpha never the
    /// acceleration. The law is not cut anywhere: V' = -k |d'|^2 holds as it stands. a = 4 alpha / k^2 makes the bottom of the
    /// trench critically damped (Example A.9.1).
    pub fn within(capability: Capability) -> Self {
        let alpha = 0.5 * capability.acceleration;
        let coefficient = alpha / capability.speed;
        let a = 4.0 * alpha / (coefficient * coefficient);
        Self { trench: Hyperbolic { alpha, a }, damping: ConstantDamping { coefficient } }
    }
}

impl<T: Trench, D: Damping> GoalTracking<T, D> {
    /// The acceleration of a robot that tracks `goal`.
    pub fn steer(&self, robot: PointState, goal: GoalMotion) -> Steered {
        let (offset, closing) = (goal.position - robot.position, goal.velocity - robot.velocity);
        let distance = libm::hypot(offset.x, offset.y);
        let coefficient = self.damping.coefficient(distance);
        Steered {
            acceleration: goal.acceleration + coefficient * closing + pull(&self.trench, offset),
            lyapunov: 0.5 * closing.norm_squared() + self.trench.value(distance),
            lyapunov_rate: -coefficient * closing.norm_squared(),
        }
    }

    /// What the law adds to the goal point's acceleration, for [`Capability::saturate`].
    pub fn terms(&self, robot: PointState, goal: GoalMotion) -> Terms {
        let (offset, closing) = (goal.position - robot.position, goal.velocity - robot.velocity);
        let damping = self.damping.coefficient(libm::hypot(offset.x, offset.y)) * closing;
        Terms { walls: Vector2::zeros(), attraction: pull(&self.trench, offset), damping }
    }
}

/// Phi'(d) d_hat. On the goal point, where d_hat does not exist, the gradient contains 0 and the force is 0.
#[inline(always)]
pub(crate) fn pull<V: Plane>(trench: &impl Trench, offset: V) -> V {
    let (distance, none) = (offset.norm(), V::Number::splat(0.0));
    let factor = distance.each(|distance| trench.slope(distance)) / distance;
    factor.or(none.is_below(distance), none) * offset
}
