//! The repulsive potential of apparent obstacles, Psi_hat^ob of (7.12) and Phi_ob of (7.9).
use super::barrier::Barrier;
use super::{Edge, Sharpness};

/// Psi_hat over the gap between a robot and the outline of an apparent obstacle. The thesis gives radii about the centre of a
/// disc ("1, 2, 3" in 7.10) without saying where pole and cut lie; they are pole 2 and cut 3 there (ERRATA).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ObstaclePotential {
    pole: f64,
    cut: f64,
    barrier: Barrier,
}

/// Parameters that make no potential.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ObstaclePotentialError {
    /// A number that is not positive and finite, or a negative pole.
    #[error("{name} of the obstacle potential is {value}; it must be finite and positive (the pole may be 0)")]
    NotPositive {
        /// Which.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A potential without width.
    #[error("the obstacle potential has its pole at {pole} m and is cut at {cut} m; the cut must be farther out")]
    Order {
        /// Gap at the pole, m.
        pole: f64,
        /// Gap at the cut, m.
        cut: f64,
    },
}

impl ObstaclePotential {
    /// Nothing from the gap `cut` (m) on, strength/(2 (gap - pole)^m) inside, and the constant force `full_acceleration` (m/s^2)
    /// where that would be more, the pole and the obstacle itself included.
    ///
    /// # Errors
    /// Numbers that are not positive and finite; a cut that is not beyond the pole.
    pub fn new(
        pole: f64,
        cut: f64,
        strength: f64,
        sharpness: Sharpness,
        edge: Edge,
        full_acceleration: f64,
    ) -> Result<Self, ObstaclePotentialError> {
        let named = [("cut", cut), ("strength", strength), ("full acceleration", full_acceleration)];
        for (name, value) in named {
            if !(value.is_finite() && value > 0.0) {
                return Err(ObstaclePotentialError::NotPositive { name, value });
            }
        }
        if !(pole.is_finite() && pole >= 0.0) {
            return Err(ObstaclePotentialError::NotPositive { name: "pole", value: pole });
        }
        if pole >= cut {
            return Err(ObstaclePotentialError::Order { pole, cut });
        }
        Ok(Self { pole, cut, barrier: Barrier::new(strength, sharpness, cut - pole, edge, full_acceleration) })
    }

    /// The force beyond the pole, which is the largest there is, m/s^2.
    pub fn full_acceleration(&self) -> f64 {
        self.barrier.cap()
    }

    /// Gap at the pole, m: 0 where that is the outline itself.
    pub fn pole(&self) -> f64 {
        self.pole
    }

    /// Gap at which the repulsion begins, m: the clearance that encroaches on segments.
    #[inline]
    pub fn cut(&self) -> f64 {
        self.cut
    }

    /// Gap that keeps well off the pole, a quarter of the way to the cut, m: where ways past obstacles are laid.
    pub fn pole_with_margin(&self) -> f64 {
        self.pole + 0.25 * (self.cut - self.pole)
    }

    /// Psi_hat'(gap) <= 0, m/s^2.
    #[inline]
    pub fn force(&self, gap: f64) -> f64 {
        -self.barrier.slope(gap - self.pole)
    }

    /// Psi_hat(gap), 0 from the cut on, m^2/s^2.
    #[inline]
    pub fn value(&self, gap: f64) -> f64 {
        self.barrier.value(gap - self.pole)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_7_10(edge: Edge) -> ObstaclePotential {
        ObstaclePotential::new(2.0, 3.0, 10.0, Sharpness::Two, edge, 1e4).unwrap()
    }

    #[test]
    fn the_force_of_7_10_jumps_to_10() {
        let potential = of_7_10(Edge::Jump);
        assert!((potential.force(3.0 - 1e-12) + 10.0).abs() < 1e-9);
        assert_eq!((potential.force(3.0), potential.force(2.0), potential.force(-1.0)), (0.0, -1e4, -1e4));
        assert!((potential.force(2.5) + 80.0).abs() < 1e-12 && (potential.value(2.5) - 15.0).abs() < 1e-12);
        let continuous = of_7_10(Edge::Continuous);
        assert!(continuous.force(3.0 - 1e-9).abs() < 1e-6 && (continuous.force(2.5) + 70.0).abs() < 1e-12);
    }

    fn check(pole: f64, cut: f64, strength: f64, expected: &str) {
        let made = ObstaclePotential::new(pole, cut, strength, Sharpness::One, Edge::Jump, 1.0);
        let text = made.map_err(|error| error.to_string());
        assert!(text.clone().is_err_and(|text| text.contains(expected)), "{text:?}");
    }

    #[test]
    fn bad_parameters() {
        check(3.0, 2.0, 1.0, "the cut must be farther out");
        check(-1.0, 2.0, 1.0, "pole of the obstacle potential is -1");
        check(0.0, f64::NAN, 1.0, "cut of the obstacle potential is NaN");
        check(0.0, 1.0, 0.0, "strength of the obstacle potential is 0");
    }
}
