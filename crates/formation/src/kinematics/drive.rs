//! Motors of the wheels: from torques to forces on the ground, and to the wheel speeds that a robot under velocity control is given.
use super::{Axle, Hilare, HilareInput, HilareState, WheelForces, Wheels};

/// Torques of the motors about the wheels' axes, N m, forward positive.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WheelTorques {
    /// Of the left wheel.
    pub left: f64,
    /// Of the right wheel.
    pub right: f64,
}

impl WheelTorques {
    /// The larger of the two magnitudes, N m.
    pub fn peak(self) -> f64 {
        self.left.abs().max(self.right.abs())
    }
}

/// Two driven wheels that roll without slip and whose own inertia is in the body's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WheelDrive {
    /// Where the wheels are.
    pub axle: Axle,
    /// Of a wheel, m, positive.
    pub radius: f64,
    /// The most torque that a motor has, N m, positive.
    pub most: f64,
}

impl WheelDrive {
    /// The torques that make up force and torque on the body, whether or not the motors have them: each the wheel's force times its radius.
    pub fn torques(self, input: HilareInput) -> WheelTorques {
        let WheelForces { left, right } = self.axle.forces(input);
        WheelTorques { left: self.radius * left, right: self.radius * right }
    }

    /// What the motors give of `wanted`: each for itself, so that where one saturates the body turns otherwise than it was told.
    pub fn given(self, wanted: WheelTorques) -> WheelTorques {
        let give = |torque: f64| torque.clamp(-self.most, self.most);
        WheelTorques { left: give(wanted.left), right: give(wanted.right) }
    }

    /// Force and torque on the body under torques of the motors.
    pub fn input(self, torques: WheelTorques) -> HilareInput {
        self.axle.input(WheelForces { left: torques.left / self.radius, right: torques.right / self.radius })
    }

    /// The way of an input through the motors: what of it arrives at the body.
    pub fn through(self, input: HilareInput) -> HilareInput {
        self.input(self.given(self.torques(input)))
    }

    /// The wheel speeds (m/s) that torques held for `duration` (s) bring about: the command by which a robot that takes velocities does what
    /// one that is driven by torques does.
    pub fn speeds_after(self, body: Hilare, state: HilareState, torques: WheelTorques, duration: f64) -> Wheels {
        self.axle.wheels(body.advanced(state, self.input(torques), duration).twist)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::{Pose, Twist};
    use proptest::prelude::*;

    const DRIVE: WheelDrive = WheelDrive { axle: Axle { half_track: 0.15 }, radius: 0.05, most: 0.4 };
    const BODY: Hilare = Hilare { mass: 4.0, inertia: 0.05, mass_offset: 0.1, hand_offset: 0.2 };

    proptest! {
        #[test]
        fn motors_give_what_is_wanted_up_to_their_most(force in -20.0..20.0_f64, torque in -4.0..4.0_f64) {
            let input = HilareInput { force, torque };
            let (wanted, arrives) = (DRIVE.torques(input), DRIVE.through(input));
            prop_assert!(DRIVE.given(wanted).peak() <= DRIVE.most);
            let off = (arrives.force - force).abs() + (arrives.torque - torque).abs();
            // F = (tau_L + tau_R)/r, tau = C_d (tau_R - tau_L)/r.
            let sum = (wanted.left + wanted.right) / DRIVE.radius;
            prop_assert!((sum - force).abs() < 1e-12);
            prop_assert_eq!(wanted.peak() <= DRIVE.most, off < 1e-12);
        }
    }

    #[test]
    fn a_saturated_wheel_leaves_the_other_alone() {
        let given = DRIVE.given(WheelTorques { left: -0.1, right: 0.9 });
        assert_eq!(given, WheelTorques { left: -0.1, right: 0.4 });
    }

    /// The distance, after 2 s, of a robot that is commanded wheel speeds every `step` from one that is driven by the torques.
    fn apart(step: f64) -> f64 {
        let mut driven = HilareState { pose: Pose::new(0.1, -0.2, 0.4), twist: Twist { v: 0.3, omega: -0.5 } };
        let (mut commanded, mut wheels) = (driven.pose, DRIVE.axle.wheels(driven.twist));
        for index in 0..(2.0 / step).round() as u32 {
            let time = f64::from(index) * step;
            let torques = DRIVE.given(WheelTorques { left: 0.3 * libm::sin(3.0 * time), right: 0.2 * libm::cos(time) });
            let after = DRIVE.speeds_after(BODY, driven, torques, step);
            driven = BODY.advanced(driven, DRIVE.input(torques), step);
            // Ramps from one command to the next: their mean drives the step.
            let mean = Wheels { left: 0.5 * (wheels.left + after.left), right: 0.5 * (wheels.right + after.right) };
            commanded = commanded.advanced(DRIVE.axle.twist(mean), step);
            wheels = after;
        }
        (commanded.position() - driven.pose.position()).norm()
    }

    /// A robot that takes velocity commands, given these speeds, goes where the torques take the other: up to an error of order two.
    #[test]
    fn wheel_speeds_do_what_torques_do() {
        let [coarse, fine] = [0.02, 0.01].map(apart);
        assert!((3.0..5.0).contains(&(coarse / fine)), "{coarse} {fine}");
        assert!(fine < 1e-3, "{fine}");
    }
}
