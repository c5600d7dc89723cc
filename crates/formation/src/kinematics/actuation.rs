//! From forces to motion: what the wheels of a Hilare robot do, for plants and for robots that take velocities.
use super::{Axle, Hilare, HilareInput, HilareState, Pose, Twist};
use crate::stability::rk4;
use nalgebra::SVector;

/// Forces of the wheels on the ground, newtons, forward positive; a motor's torque is the force times the wheel's radius.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WheelForces {
    /// Of the left wheel.
    pub left: f64,
    /// Of the right wheel.
    pub right: f64,
}

impl Axle {
    /// F = f_L + f_R, tau = C_d (f_R - f_L).
    pub fn input(self, forces: WheelForces) -> HilareInput {
        HilareInput { force: forces.left + forces.right, torque: self.half_track * (forces.right - forces.left) }
    }

    /// The wheel forces that make up `input`.
    pub fn forces(self, input: HilareInput) -> WheelForces {
        let (common, difference) = (0.5 * input.force, 0.5 * input.torque / self.half_track);
        WheelForces { left: common - difference, right: common + difference }
    }
}

impl Hilare {
    /// The state after `duration` (s) of constant `input`, by one step of RK4. The wheel speeds that a robot under velocity
    /// control must follow are those of the twist ([`Axle::wheels`]).
    #[must_use]
    pub fn advanced(self, state: HilareState, input: HilareInput, duration: f64) -> HilareState {
        let HilareState { pose, twist } = state;
        let start = SVector::<f64, 5>::new(pose.x, pose.y, pose.theta, twist.v, twist.omega);
        let end = rk4(0.0, start, duration, |_, now| {
            let (sin, cos) = libm::sincos(now[2]);
            let rates = self.rates(Twist { v: now[3], omega: now[4] }, input);
            SVector::<f64, 5>::new(now[3] * cos, now[3] * sin, now[4], rates.v, rates.omega)
        });
        HilareState { pose: Pose::new(end[0], end[1], end[2]), twist: Twist { v: end[3], omega: end[4] } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vector2;
    use crate::kinematics::PointState;
    use proptest::prelude::*;

    const AXLE: Axle = Axle { half_track: 0.06 };

    proptest! {
        #[test]
        fn forces_and_inputs_are_inverses(force in -5.0..5.0_f64, torque in -1.0..1.0_f64) {
            let back = AXLE.input(AXLE.forces(HilareInput { force, torque }));
            prop_assert!((back.force - force).abs() < 1e-14 && (back.torque - torque).abs() < 1e-14);
        }

        /// Without forces the kinetic energy stays, wherever the mass sits: (m v^2 + (J + m c^2) omega^2)/2.
        #[test]
        fn coasting_keeps_the_energy(c in -0.05..0.05_f64, v in -1.0..1.0_f64, omega in -3.0..3.0_f64) {
            let body = Hilare { mass: 1.2, inertia: 0.02, mass_offset: c, hand_offset: 0.1 };
            let energy = |twist: Twist| 1.2 * twist.v * twist.v + (0.02 + 1.2 * c * c) * twist.omega * twist.omega;
            let mut state = HilareState { pose: Pose::default(), twist: Twist { v, omega } };
            let before = energy(state.twist);
            for _ in 0..200 {
                state = body.advanced(state, HilareInput::default(), 0.005);
            }
            prop_assert!((energy(state.twist) - before).abs() < 1e-8 * (1.0 + before));
        }
    }

    /// T2 through the wheels: under a constant u the hand follows the double integrator (3.4).
    #[test]
    fn a_hand_driven_through_the_wheels_is_a_double_integrator() {
        let body = Hilare { mass: 1.2, inertia: 0.02, mass_offset: 0.03, hand_offset: 0.1 };
        let mut state = HilareState { pose: Pose::new(0.1, 0.2, 0.5), twist: Twist { v: 0.3, omega: -0.4 } };
        let (start, wanted) = (body.to_hand(state).hand, Vector2::new(0.2, -0.1));
        for _ in 0..2000 {
            let forces = AXLE.forces(body.feedback(state, wanted));
            state = body.advanced(state, AXLE.input(forces), 0.001);
        }
        let expected: PointState = start.advanced(wanted, 2.0);
        let hand = body.to_hand(state).hand;
        assert!((hand.position - expected.position).norm() < 2e-3, "{} {}", hand.position, expected.position);
        assert!((hand.velocity - expected.velocity).norm() < 2e-3);
    }
}
