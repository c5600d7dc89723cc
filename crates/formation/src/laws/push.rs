//! The terms of (7.12) besides the trench.
use super::zoned::direction;
use crate::Vector2;
use crate::hull::Approach;
use crate::trench::Trench;
use crate::zoning::{ObstaclePotential, Zoning};

/// The gradient and value of one potential between a robot and something it keeps from, or keeps near to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Push {
    /// Force, m/s^2.
    pub force: Vector2<f64>,
    /// Potential, m^2/s^2.
    pub value: f64,
}

impl Push {
    /// Psi of the leader: repulsive in zone 2, attractive from zone 4 on.
    #[inline(always)]
    pub fn of_leader(zoning: &Zoning, robot: Vector2<f64>, leader: Vector2<f64>) -> Self {
        let radii = zoning.radii();
        let (towards, distance) = direction(leader - robot);
        if (radii.rho_hat..=radii.rho).contains(&distance) {
            return Self { force: Vector2::zeros(), value: 0.0 };
        }
        Self { force: zoning.force(distance) * towards, value: zoning.value(distance) }
    }

    /// Psi of the leader, but for its attraction: that of the trench, from the neutral zone on.
    pub fn of_leader_by(trench: &impl Trench, zoning: &Zoning, robot: Vector2<f64>, leader: Vector2<f64>) -> Self {
        let (towards, distance) = direction(leader - robot);
        let beyond = distance - zoning.radii().rho;
        if beyond <= 0.0 {
            return Self::of_robot_ahead(zoning, robot, leader);
        }
        Self { force: trench.slope(beyond) * towards, value: trench.value(beyond) }
    }

    /// Psi_hat of another robot ahead in the chain: repulsive in zone 2.
    #[inline]
    pub fn of_robot_ahead(zoning: &Zoning, robot: Vector2<f64>, other: Vector2<f64>) -> Self {
        let offset = other - robot;
        let reach = zoning.radii().rho_hat;
        if offset.norm_squared() >= reach * reach {
            return Self { force: Vector2::zeros(), value: 0.0 };
        }
        let (towards, distance) = direction(offset);
        Self { force: zoning.repulsion(distance) * towards, value: zoning.repulsive_value(distance) }
    }

    /// Psi_hat^ob of an apparent obstacle, (7.9).
    #[inline]
    pub fn of_obstacle(potential: &ObstaclePotential, approach: Approach) -> Self {
        Self { force: potential.force(approach.gap) * approach.towards, value: potential.value(approach.gap) }
    }
}
