//! Law (3.13), the thesis's improvement of (3.10).
use super::PointLaw;
use crate::kinematics::{Polar, Twist};

/// v = K1 r cos phi, omega = -K3 sin phi cos phi - K2 phi, with K3 not necessarily K1.
///
/// Closed loop (3.18): r' = -K1 r cos^2 phi, phi' = -K2 phi - K4 sin 2 phi. Which gains make it stable is
/// [`StableZone`](crate::stability::StableZone)'s matter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Robust {
    /// K1, 1/s.
    pub k1: f64,
    /// K2, 1/s.
    pub k2: f64,
    /// K3, 1/s.
    pub k3: f64,
}

impl Robust {
    /// K4 = (K3 - K1)/2 of (4.8), 1/s.
    pub fn k4(self) -> f64 {
        0.5 * (self.k3 - self.k1)
    }

    /// d(phi)/dt of the closed loop, (4.8), rad/s.
    pub fn misalignment_rate(self, misalignment: f64) -> f64 {
        -self.k2 * misalignment - self.k4() * libm::sin(2.0 * misalignment)
    }
}

impl PointLaw for Robust {
    fn twist(&self, polar: Polar) -> Twist {
        let (sin, cos) = libm::sincos(polar.misalignment);
        Twist { v: self.k1 * polar.distance * cos, omega: -self.k3 * sin * cos - self.k2 * polar.misalignment }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::Nominal;
    use proptest::prelude::*;

    proptest! {
        /// (3.18) is what (3.8) makes of the law; with K3 = K1 it is (3.11).
        #[test]
        fn closed_loop(r in 0.01..5.0_f64, phi in -3.1..3.1_f64, k1 in 0.0..5.0_f64, k2 in 0.1..5.0_f64, k3 in 0.0..9.0_f64) {
            let (law, polar) = (Robust { k1, k2, k3 }, Polar { distance: r, misalignment: phi });
            let rates = polar.rates(law.twist(polar));
            prop_assert!((rates.distance + k1 * r * libm::cos(phi) * libm::cos(phi)).abs() < 1e-12);
            prop_assert!((rates.misalignment - law.misalignment_rate(phi)).abs() < 1e-12);
            let nominal = polar.rates(Nominal { k1, k2 }.twist(polar));
            prop_assert!((nominal.misalignment + k2 * phi).abs() < 1e-12);
        }
    }
}
