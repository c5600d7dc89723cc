//! Psi = Psi_hat + Psi_check of 6.4.
use super::barrier::Barrier;
use super::{Radii, Zone};

/// m of the potentials.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sharpness {
    /// m = 1: alpha/(2 delta).
    One,
    /// m = 2: alpha/(2 delta^2).
    Two,
}

/// What happens where a potential sets in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edge {
    /// As printed: the potential is continuous, the force jumps (by 10/27 at the edges of Table 6.2), and robots bounce.
    Jump,
    /// The force is lowered by that jump all over the zone: it begins at 0 and the poles stay.
    Continuous,
}

/// The zoning potential of one robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zoning {
    radii: Radii,
    repulsion: Barrier,
    attraction: Barrier,
}

/// Parameters that make no zoning potential.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{name} of the zoning potential is {value}; it must be positive and finite")]
pub struct ZoningError {
    /// Which.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
}

impl Zoning {
    /// `strength` is alpha of Psi_hat and beta of Psi_check; `full_acceleration` (m/s^2) bounds the force within the zones
    /// and is applied beyond rho_check and below rho_underbar, as 6.4 asks.
    ///
    /// # Errors
    /// When a number is not positive and finite.
    pub fn new(
        radii: Radii,
        strength: (f64, f64),
        sharpness: Sharpness,
        edge: Edge,
        full_acceleration: f64,
    ) -> Result<Self, ZoningError> {
        for (name, value) in [("alpha", strength.0), ("beta", strength.1), ("full acceleration", full_acceleration)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(ZoningError { name, value });
            }
        }
        let barrier = |strength, width| Barrier::new(strength, sharpness, width, edge, full_acceleration);
        Ok(Self {
            radii,
            repulsion: barrier(strength.0, radii.rho_hat - radii.rho_underbar),
            attraction: barrier(strength.1, radii.rho_check - radii.rho),
        })
    }

    /// The radii.
    #[inline]
    pub fn radii(&self) -> &Radii {
        &self.radii
    }

    /// The force beyond the poles, which is the largest there is, m/s^2.
    pub fn full_acceleration(&self) -> f64 {
        self.repulsion.cap()
    }

    /// The zone in which a robot at `distance` (m) is.
    #[inline]
    pub fn zone(&self, distance: f64) -> Zone {
        self.radii.zone(distance)
    }

    /// Psi_hat'(d) <= 0: away from any robot ahead, m/s^2.
    #[inline]
    pub fn repulsion(&self, distance: f64) -> f64 {
        -self.repulsion.slope(distance - self.radii.rho_underbar)
    }

    /// Psi'(d): away from or towards the leader, m/s^2.
    #[inline(always)]
    pub fn force(&self, distance: f64) -> f64 {
        self.repulsion(distance) + self.attraction.slope(self.radii.rho_check - distance)
    }

    /// Psi_hat(d), 0 from rho_hat on, m^2/s^2.
    #[inline]
    pub fn repulsive_value(&self, distance: f64) -> f64 {
        self.repulsion.value(distance - self.radii.rho_underbar)
    }

    /// Psi(d), 0 in the neutral zone, m^2/s^2. Bounded forces make it finite: its value at rho_underbar and at rho_check is
    /// the energy that carries a robot out of the zones, which A.12 (i) has as infinite.
    #[inline(always)]
    pub fn value(&self, distance: f64) -> f64 {
        self.repulsive_value(distance) + self.attraction.value(self.radii.rho_check - distance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table_6_2(edge: Edge) -> Zoning {
        Zoning::new(Radii::new(1.0, 4.0, 10.0, 13.0, 30.0).unwrap(), (10.0, 10.0), Sharpness::Two, edge, 1e6).unwrap()
    }

    #[test]
    fn printed_potentials_of_6_5() {
        let zoning = table_6_2(Edge::Jump);
        // 5/(d - 1)^2 - 5/9 and 5/(13 - d)^2 - 5/9 with their slopes.
        assert!((zoning.value(2.0) - (5.0 - 5.0 / 9.0)).abs() < 1e-14);
        assert!((zoning.value(12.5) - (20.0 - 5.0 / 9.0)).abs() < 1e-14);
        assert!((zoning.force(2.0) + 10.0).abs() < 1e-14 && (zoning.force(12.0) - 10.0).abs() < 1e-14);
        assert!((zoning.force(4.0 - 1e-12) + 10.0 / 27.0).abs() < 1e-9);
        assert_eq!((zoning.force(4.0), zoning.force(7.0), zoning.force(10.0), zoning.value(7.0)), (0.0, 0.0, 0.0, 0.0));
        assert_eq!((zoning.repulsion(12.0), zoning.repulsion(0.5)), (0.0, -1e6));
    }

    #[test]
    fn beyond_the_poles_full_acceleration() {
        let radii = Radii::new(1.0, 4.0, 10.0, 13.0, 30.0).unwrap();
        let zoning = Zoning::new(radii, (10.0, 10.0), Sharpness::One, Edge::Continuous, 3.0).unwrap();
        assert_eq!(
            (zoning.force(0.5), zoning.force(1.0), zoning.force(13.0), zoning.force(40.0)),
            (-3.0, -3.0, 3.0, 3.0)
        );
        assert!(zoning.force(3.999_999).abs() < 1e-5 && zoning.force(10.000_001) < 1e-5);
        assert!(Zoning::new(radii, (10.0, 0.0), Sharpness::One, Edge::Jump, 3.0).is_err());
    }
}
