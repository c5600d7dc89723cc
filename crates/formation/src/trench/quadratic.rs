//! Example 5.2.1 with m = 2; critically damped by k = 2 sqrt(alpha) (Example A.9.1).
use super::{Interval, Slopes, Trench, convex_bounds};

/// Phi = alpha x^2 / 2. Only locally Lipschitz, which is what Definition 5.2.1 should ask for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quadratic {
    /// 1/s^2.
    pub alpha: f64,
}

impl Trench for Quadratic {
    fn value(&self, x: f64) -> f64 {
        0.5 * self.alpha * x * x
    }

    fn slopes(&self, x: f64) -> Slopes {
        Slopes::smooth(self.alpha * x)
    }
    fn slope_bounds(&self, low: f64, high: f64) -> Option<Interval> {
        convex_bounds(self, low, high)
    }
}
