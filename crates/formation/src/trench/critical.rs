//! Corollary A.9.1 as a constructor: damping in, potential out.
use super::{Damping, Interval, Slopes, Trench, convex_bounds};

/// Phi = K^2/8 and phi = K k/4: with the damping k the equation (11) returns to 0 at the edge of overshooting, if k > 0
/// except at 0 and the integral of 1/K diverges at 0 (it does whenever k is bounded there).
///
/// A trench of beta^2 in the place of alpha^2 overshoots for beta > alpha (the thesis says the opposite).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CriticallyDamped<D>(pub D);

impl<D: Damping> Trench for CriticallyDamped<D> {
    fn value(&self, x: f64) -> f64 {
        let integral = self.0.integral(x);
        0.125 * integral * integral
    }

    fn slopes(&self, x: f64) -> Slopes {
        let (integral, Slopes { left, right }) = (self.0.integral(x), self.0.coefficients(x));
        Slopes { left: 0.25 * integral * left, right: 0.25 * integral * right }
    }

    fn kinks(&self) -> Vec<f64> {
        self.0.kinks()
    }

    fn slope_bounds(&self, low: f64, high: f64) -> Option<Interval> {
        if self.0.never_falls() {
            return convex_bounds(self, low, high);
        }
        // K never falls, as k is not negative.
        let (k, integrals) = (self.0.bounds(low, high)?, [self.0.integral(low), self.0.integral(high)]);
        let products = integrals.map(|integral| [0.25 * integral * k.low, 0.25 * integral * k.high]);
        let all = products.into_iter().flatten();
        let hull = |all: Interval, slope: f64| Interval { low: all.low.min(slope), high: all.high.max(slope) };
        Some(all.fold(Interval { low: f64::INFINITY, high: f64::NEG_INFINITY }, hull))
    }
}
