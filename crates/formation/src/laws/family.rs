//! The family (4.4) of stabilising laws.
use super::PointLaw;
use crate::kinematics::{Polar, Twist};

/// v = K1 r^(n+1) phi^(2q) cos^(2p+1) phi,
/// omega = -K1 r^n phi^(2q) sin phi cos^(2p+1) phi - K2 phi^(2s+1).
///
/// Only q = 0 stabilises the goal point (ERRATA, Proposition 4.1.1): for q >= 1 every (r, 0) is an equilibrium.
/// (3.9) is no member: its power of cos is even.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Family {
    /// K1, 1/(s m^n).
    pub k1: f64,
    /// K2, 1/s.
    pub k2: f64,
    /// Power of r beyond the first.
    pub n: u32,
    /// Half the even part of the power of cos phi.
    pub p: u32,
    /// Half the power of phi in v.
    pub q: u32,
    /// Half the even part of the power of phi in omega.
    pub s: u32,
}

impl Family {
    /// Whether this member drives r and phi to 0 from almost everywhere, rather than only keeping V from growing.
    pub fn is_asymptotically_stable(self) -> bool {
        self.q == 0 && self.k1 > 0.0 && self.k2 > 0.0
    }
}

impl PointLaw for Family {
    fn twist(&self, polar: Polar) -> Twist {
        let Polar { distance: r, misalignment: phi } = polar;
        let (sin, cos) = libm::sincos(phi);
        let g1 = self.k1 * power(r, self.n) * power(phi * phi, self.q) * cos * power(cos * cos, self.p);
        Twist { v: g1 * r, omega: -g1 * sin - self.k2 * phi * power(phi * phi, self.s) }
    }
}

/// Square and multiply, so that the result is the same on every machine.
fn power(mut base: f64, mut exponent: u32) -> f64 {
    let mut result = 1.0;
    while exponent > 0 {
        if exponent & 1 == 1 {
            result *= base;
        }
        base *= base;
        exponent >>= 1;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{Lyapunov, Nominal};
    use proptest::prelude::*;

    #[test]
    fn the_simplest_member_is_3_10() {
        let family = Family { k1: 0.7, k2: 1.3, n: 0, p: 0, q: 0, s: 0 };
        let polar = Polar { distance: 1.2, misalignment: -2.1 };
        let (a, b) = (family.twist(polar), Nominal { k1: 0.7, k2: 1.3 }.twist(polar));
        assert!((a.v - b.v).abs() < 1e-15 && (a.omega - b.omega).abs() < 1e-15);
    }

    proptest! {
        /// A.1 (3): V' = -K1 phi^(2q) r^(n+2) cos^(2p+2) phi - K2 phi^(2s+2).
        #[test]
        fn lyapunov_derivative(
            r in 0.05..2.0_f64, phi in -3.0..3.0_f64, n in 0_u32..3, p in 0_u32..3, q in 0_u32..3, s in 0_u32..3,
        ) {
            let polar = Polar { distance: r, misalignment: phi };
            let got = Lyapunov::of(polar, Family { k1: 0.8, k2: 0.5, n, p, q, s }.twist(polar)).rate;
            let cos = libm::cos(phi);
            let expected = -0.8 * phi.powi(2 * q as i32) * r.powi(n as i32 + 2) * cos.powi(2 * p as i32 + 2)
                - 0.5 * phi.powi(2 * s as i32 + 2);
            prop_assert!((got - expected).abs() < 1e-10 * (1.0 + expected.abs()), "{got} {expected}");
            prop_assert!(got <= 0.0);
        }
    }
}
