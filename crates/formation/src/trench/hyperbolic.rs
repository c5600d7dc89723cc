//! Example 5.2.2, the trench of [29] and of the simulations of 5.6, 6.5 and 7.10.
use super::{Interval, Slopes, Trench, convex_bounds};

/// Phi = alpha (sqrt(x^2 + a^2) - a): a spring alpha/a near the bottom, a pull of at most alpha far away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hyperbolic {
    /// m/s^2.
    pub alpha: f64,
    /// Metres, positive ([`Conic`](super::Conic) is the case 0).
    pub a: f64,
}

impl Hyperbolic {
    /// sqrt(x^2 + a^2): no distance overflows it, and it is far quicker than hypot.
    fn root(&self, x: f64) -> f64 {
        (x * x + self.a * self.a).sqrt()
    }
}

impl Trench for Hyperbolic {
    fn value(&self, x: f64) -> f64 {
        // sqrt(x^2 + a^2) - a without the cancellation near 0.
        self.alpha * x * x / (self.root(x) + self.a)
    }

    fn slopes(&self, x: f64) -> Slopes {
        Slopes::smooth(self.alpha * x / self.root(x))
    }
    fn slope_bounds(&self, low: f64, high: f64) -> Option<Interval> {
        convex_bounds(self, low, high)
    }
}
