//! Law (3.9), of [36].
use super::PointLaw;
use crate::kinematics::{Polar, Twist};

/// v = K1 r, omega = -K1 sin phi - K2 phi. Always drives forward; r grows at first when |phi| > pi/2.
///
/// | thesis | here |
/// |---|---|
/// | K1, K2 | [`Self::k1`], [`Self::k2`] |
/// | r, phi | [`Polar::distance`], [`Polar::misalignment`] |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direct {
    /// K1, 1/s.
    pub k1: f64,
    /// K2, 1/s.
    pub k2: f64,
}

impl PointLaw for Direct {
    fn twist(&self, polar: Polar) -> Twist {
        let Polar { distance, misalignment } = polar;
        Twist { v: self.k1 * distance, omega: -self.k1 * libm::sin(misalignment) - self.k2 * misalignment }
    }
}
