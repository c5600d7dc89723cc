//! Dynamics of a Hilare-type robot and its feedback linearisation, 3.1.1.
//!
//! The thesis calls (x_h, y_h) the centre of mass, yet writes v' = F/m and omega' = tau/J, which hold only when the mass
//! sits on the axle (ERRATA, 3.1.1). Here (x_h, y_h) is the "hand", a look-ahead point `hand_offset` in front of the
//! axle that the feedback makes a double integrator, and the centre of mass has an offset of its own; 0 gives the print:
//!
//! m (v' - c omega^2) = F,  (J + m c^2) omega' + m c v omega = tau.
use super::{PointState, Pose, Twist};
use crate::Vector2;

/// Parameters of the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hilare {
    /// m, kg, positive.
    pub mass: f64,
    /// J about the centre of mass, kg m^2, positive.
    pub inertia: f64,
    /// c: from the axle forward to the centre of mass, metres.
    pub mass_offset: f64,
    /// L: from the axle forward to the hand, metres; not 0, or T1 has no inverse.
    pub hand_offset: f64,
}

/// q = (x, y, theta, v, omega).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HilareState {
    /// Centre of the wheels and heading.
    pub pose: Pose,
    /// v and omega.
    pub twist: Twist,
}

/// mu = (F, tau), the physical inputs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HilareInput {
    /// F, newtons, forward.
    pub force: f64,
    /// tau, newton metres, counter-clockwise.
    pub torque: f64,
}

/// Accelerations of the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HilareRates {
    /// dv/dt, m/s^2.
    pub v: f64,
    /// d(omega)/dt, rad/s^2.
    pub omega: f64,
}

/// Xi = (xi_1 ... xi_5): the hand's position and velocity in `map`, and the heading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandState {
    /// (xi_1, xi_2) and (xi_3, xi_4).
    pub hand: PointState,
    /// xi_5, radians.
    pub theta: f64,
}

impl Hilare {
    /// Accelerations under `input` (the last two lines of the equations of motion).
    pub fn rates(self, twist: Twist, input: HilareInput) -> HilareRates {
        let Self { mass, inertia, mass_offset, .. } = self;
        HilareRates {
            v: input.force / mass + mass_offset * twist.omega * twist.omega,
            omega: (input.torque - mass * mass_offset * twist.v * twist.omega)
                / (inertia + mass * mass_offset * mass_offset),
        }
    }

    /// The diffeomorphism T1.
    pub fn to_hand(self, state: HilareState) -> HandState {
        let (ahead, left) = axes(state.pose.theta);
        HandState {
            hand: PointState {
                position: state.pose.position() + self.hand_offset * ahead,
                velocity: state.twist.v * ahead + self.hand_offset * state.twist.omega * left,
            },
            theta: state.pose.theta,
        }
    }

    /// The inverse of T1.
    pub fn from_hand(self, state: HandState) -> HilareState {
        let (ahead, _) = axes(state.theta);
        let position = state.hand.position - self.hand_offset * ahead;
        HilareState {
            pose: Pose::new(position.x, position.y, state.theta),
            twist: twist_of_hand(state.theta, self.hand_offset, state.hand.velocity),
        }
    }

    /// The state feedback T2: forces under which the hand's acceleration is `acceleration`, (3.2) and (3.4).
    pub fn feedback(self, state: HilareState, acceleration: Vector2<f64>) -> HilareInput {
        let (ahead, left) = axes(state.pose.theta);
        let Twist { v, omega } = state.twist;
        let forward = acceleration.dot(&ahead) + self.hand_offset * omega * omega;
        let turning = (acceleration.dot(&left) - v * omega) / self.hand_offset;
        let Self { mass, inertia, mass_offset, .. } = self;
        HilareInput {
            force: mass * (forward - mass_offset * omega * omega),
            torque: (inertia + mass * mass_offset * mass_offset) * turning + mass * mass_offset * v * omega,
        }
    }
}

/// The velocity command that moves a hand `hand_offset` metres ahead of the axle with `velocity` (frame `map`): how a law
/// for double integrators drives a robot that takes velocities; its second component is the internal dynamics (3.3).
pub fn twist_of_hand(theta: f64, hand_offset: f64, velocity: Vector2<f64>) -> Twist {
    let (ahead, left) = axes(theta);
    Twist { v: velocity.dot(&ahead), omega: velocity.dot(&left) / hand_offset }
}

fn axes(theta: f64) -> (Vector2<f64>, Vector2<f64>) {
    let (sin, cos) = libm::sincos(theta);
    (Vector2::new(cos, sin), Vector2::new(-sin, cos))
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use proptest::prelude::*;

    fn body(mass_offset: f64) -> Hilare {
        Hilare { mass: 1.3, inertia: 0.02, mass_offset, hand_offset: 0.1 }
    }

    fn state(theta: f64, v: f64, omega: f64) -> HilareState {
        HilareState { pose: Pose::new(0.4, -0.7, theta), twist: Twist { v, omega } }
    }

    proptest! {
        #[test]
        fn the_inverse_undoes_t1(theta in -PI..PI, v in -1.0..1.0_f64, omega in -4.0..4.0_f64) {
            let before = state(theta, v, omega);
            let after = body(0.03).from_hand(body(0.03).to_hand(before));
            prop_assert!((after.pose.position() - before.pose.position()).norm() < 1e-14);
            prop_assert!((after.twist.v - v).abs() < 1e-13 && (after.twist.omega - omega).abs() < 1e-12);
        }

        /// The hand's acceleration, by a central difference along the true motion, is what was asked for, wherever the
        /// mass sits.
        #[test]
        fn feedback_makes_the_hand_a_double_integrator(
            theta in -PI..PI, v in -1.0..1.0_f64, omega in -4.0..4.0_f64, c in -0.05..0.05_f64,
            ux in -2.0..2.0_f64, uy in -2.0..2.0_f64,
        ) {
            let (body, now, wanted, step) = (body(c), state(theta, v, omega), Vector2::new(ux, uy), 1e-5);
            let rates = body.rates(now.twist, body.feedback(now, wanted));
            let at = |time: f64| body.to_hand(HilareState {
                pose: now.pose.advanced(now.twist, time),
                twist: Twist { v: v + rates.v * time, omega: omega + rates.omega * time },
            });
            let got = (at(step).hand.velocity - at(-step).hand.velocity) / (2.0 * step);
            prop_assert!((got - wanted).norm() < 1e-6, "{got} {wanted}");
        }
    }
}
