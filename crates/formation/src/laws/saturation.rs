//! What bounded actuators leave of a law that comes from a potential (9.2).
use super::Capability;
use crate::Vector2;
use crate::lanes::{Number, Plane};

/// The terms of a law relative to the segment, m/s^2: what comes from potentials, and the rest. Of one robot, or of several side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Terms<V = Vector2<f64>> {
    /// Repulsion and attraction of zones and obstacles.
    pub walls: V,
    /// Minus the gradient of the trench's Phi: Phi' d_hat, and under (6.1) what [`Attraction::sliding`](super::Attraction::sliding) adds.
    pub attraction: V,
    /// -k r' and what else takes power out or does no work. Nothing that gives power belongs here: it would be cut, and the rest not.
    pub damping: V,
}

impl Capability {
    /// The law u = walls + attraction + damping within the acceleration and the speed, for a step of `step` (s) at `velocity`.
    ///
    /// Damping gives way first, by the largest factor sigma in [0, 1] with |walls + attraction + sigma damping| within the
    /// acceleration; what would be faster than the speed is damped away. The potential forces stay whole, so that
    /// V' = sigma (damping . v) - (something >= 0) keeps its sign and A.10, A.12 and A.18 hold as they stand, as long as the
    /// potential forces alone fit the acceleration: [`Self::fits`]. Otherwise the attraction gives way next, and walls last.
    #[inline]
    pub fn saturate(&self, velocity: Vector2<f64>, terms: Terms, step: f64) -> Vector2<f64> {
        let (whole, fits) = self.whole(velocity, &terms, step);
        if fits {
            return whole;
        }
        let fits = terms.walls.norm_squared() <= self.acceleration * self.acceleration;
        let walls = if fits { terms.walls } else { terms.walls.cap_magnitude(self.acceleration) };
        let potential = self.extended(walls, terms.attraction);
        let wanted = self.extended(potential, terms.damping);
        let next = velocity + step * wanted;
        // A robot that is within the speed already comes to it by less than the acceleration: the speeds form a convex disc.
        if next.norm() <= self.speed { wanted } else { self.admit(velocity, wanted, step) }
    }

    /// The law as it stands, and whether nothing of it gives way.
    #[inline(always)]
    pub(crate) fn whole<V: Plane>(&self, velocity: V, terms: &Terms<V>, step: f64) -> (V, <V::Number as Number>::Mask) {
        let number = V::Number::splat;
        let potential = terms.walls + terms.attraction;
        let whole = potential + terms.damping;
        let fits = |force: V| force.norm_squared().is_at_most(number(self.acceleration * self.acceleration));
        let next = velocity + number(step) * whole;
        (whole, fits(terms.walls) & fits(potential) & fits(whole) & next.norm().is_at_most(number(self.speed)))
    }

    /// Whether potential forces of these largest magnitudes (m/s^2), all in one direction, fit the acceleration.
    pub fn fits(&self, largest: impl IntoIterator<Item = f64>) -> bool {
        largest.into_iter().sum::<f64>() <= self.acceleration
    }

    /// `base`, which fits, and as much of `more` as fits besides.
    #[inline]
    fn extended(&self, base: Vector2<f64>, more: Vector2<f64>) -> Vector2<f64> {
        let square = more.norm_squared();
        let whole = base + more;
        if square == 0.0 || whole.norm_squared() <= self.acceleration * self.acceleration {
            return whole;
        }
        let along = base.dot(&more);
        let left = (self.acceleration * self.acceleration - base.norm_squared()).max(0.0);
        let factor = ((along * along + square * left).sqrt() - along) / square;
        base + factor.clamp(0.0, 1.0) * more
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ROBOT: Capability = Capability { speed: 0.5, acceleration: 2.0 };

    fn vector(most: f64) -> impl Strategy<Value = Vector2<f64>> {
        (0.0..most, 0.0..core::f64::consts::TAU).prop_map(|(length, angle)| {
            let (sine, cosine) = libm::sincos(angle);
            length * Vector2::new(cosine, sine)
        })
    }

    proptest! {
        /// Whatever a law wants, the limits hold, and where its potentials fit them V falls: V' = v . (u - potential forces).
        #[test]
        fn limits_hold_and_energy_falls(
            walls in vector(1.4), attraction in vector(0.6), velocity in vector(0.5), damping in 0.0..20.0_f64,
        ) {
            let step = 1e-6; // the limit of the speed is exact up to terms of the order of the step
            let terms = Terms { walls, attraction, damping: -damping * velocity };
            let applied = ROBOT.saturate(velocity, terms, step);
            prop_assert!(applied.norm() <= ROBOT.acceleration * (1.0 + 1e-9));
            prop_assert!((velocity + step * applied).norm() <= ROBOT.speed * (1.0 + 1e-9));
            prop_assert!(velocity.dot(&(applied - walls - attraction)) <= 1e-5);
        }

        /// A trench that pulls with more than the acceleration is cut to min(Phi', a), which is a trench again: while nothing else acts,
        /// |v|^2/2 and the potential of that one fall together.
        #[test]
        fn a_trench_alone_is_cut_to_a_trench(
            attraction in vector(9.0), velocity in vector(0.5), damping in 0.0..20.0_f64,
        ) {
            let terms = Terms { walls: Vector2::zeros(), attraction, damping: -damping * velocity };
            let applied = ROBOT.saturate(velocity, terms, 1e-6);
            prop_assert!(velocity.dot(&(applied - attraction.cap_magnitude(ROBOT.acceleration))) <= 1e-5);
        }

        #[test]
        fn limits_hold_beyond_what_fits(walls in vector(9.0), attraction in vector(9.0), velocity in vector(0.5), step in 1e-3..0.05) {
            let applied = ROBOT.saturate(velocity, Terms { walls, attraction, damping: -5.0 * velocity }, step);
            prop_assert!(applied.norm() <= ROBOT.acceleration * (1.0 + 1e-9));
            prop_assert!((velocity + step * applied).norm() <= ROBOT.speed * (1.0 + 1e-9));
        }
    }

    #[test]
    fn what_fits_is_not_touched() {
        let terms = Terms {
            walls: Vector2::new(0.5, 0.0),
            attraction: Vector2::new(0.0, 0.3),
            damping: Vector2::new(0.1, 0.1),
        };
        assert_eq!(ROBOT.saturate(Vector2::zeros(), terms, 0.01), Vector2::new(0.6, 0.4));
        assert!(ROBOT.fits([1.0, 0.5, 0.5]) && !ROBOT.fits([1.0, 1.0, 0.1]));
    }
}
