//! Wheel speeds and body velocity: (3.14)-(3.16), with the matrices of ERRATA (the printed ones are singular or mirrored).
use super::Twist;

/// Speeds of the wheels over the ground, m/s, forward positive.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Wheels {
    /// v_L.
    pub left: f64,
    /// v_R.
    pub right: f64,
}

impl Wheels {
    /// Both wheels at rest.
    pub const ZERO: Self = Self { left: 0.0, right: 0.0 };

    /// The larger of the two magnitudes, m/s.
    pub fn peak(self) -> f64 {
        self.left.abs().max(self.right.abs())
    }

    pub(super) fn scaled(self, factor: f64) -> Self {
        Self { left: factor * self.left, right: factor * self.right }
    }
}

/// The axle of a differential drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axle {
    /// C_d: distance from the centre to each wheel, metres, positive.
    pub half_track: f64,
}

impl Axle {
    /// (3.16) as corrected: v_L = v - C_d omega, v_R = v + C_d omega.
    pub fn wheels(self, twist: Twist) -> Wheels {
        let swing = self.half_track * twist.omega;
        Wheels { left: twist.v - swing, right: twist.v + swing }
    }

    /// (3.14): v = (v_L + v_R)/2, omega = (v_R - v_L)/(2 C_d).
    pub fn twist(self, wheels: Wheels) -> Twist {
        Twist { v: 0.5 * (wheels.left + wheels.right), omega: (wheels.right - wheels.left) / (2.0 * self.half_track) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn turning_left_runs_the_right_wheel_forward() {
        let wheels = Axle { half_track: 0.06 }.wheels(Twist { v: 0.0, omega: 1.0 });
        assert_eq!(wheels, Wheels { left: -0.06, right: 0.06 });
    }

    proptest! {
        #[test]
        fn the_corrected_matrices_are_inverses(v in -1.0..1.0_f64, omega in -9.0..9.0_f64, half_track in 0.01..0.5_f64) {
            let axle = Axle { half_track };
            let back = axle.twist(axle.wheels(Twist { v, omega }));
            prop_assert!((back.v - v).abs() < 1e-13 && (back.omega - omega).abs() < 1e-12);
        }
    }
}
