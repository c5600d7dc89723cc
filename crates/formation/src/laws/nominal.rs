//! Law (3.10), of [53].
use super::{PointLaw, Robust};
use crate::kinematics::{Polar, Twist};

/// v = K1 r cos phi, omega = -K1 sin phi cos phi - K2 phi: [`Robust`] with K3 = K1, and the member n = p = q = s = 0 of
/// [`Family`](super::Family). Under it phi' = -K2 phi exactly, (3.11).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nominal {
    /// K1, 1/s.
    pub k1: f64,
    /// K2, 1/s.
    pub k2: f64,
}

impl PointLaw for Nominal {
    fn twist(&self, polar: Polar) -> Twist {
        Robust { k1: self.k1, k2: self.k2, k3: self.k1 }.twist(polar)
    }
}
