//! Phi_2 of 5.6, with the constant that makes it continuous (ERRATA: 7.07 |x| - 3.535 for |x| >= 1).
use super::{Interval, Slopes, Trench, convex_bounds};

/// Phi' = stiffness * clamp(x, -edge, edge): a spring whose force the actuator can bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Saturated {
    /// 1/s^2.
    pub stiffness: f64,
    /// Metres.
    pub edge: f64,
}

impl Trench for Saturated {
    fn value(&self, x: f64) -> f64 {
        let (size, edge) = (x.abs(), self.edge);
        if size < edge { 0.5 * self.stiffness * x * x } else { self.stiffness * edge * (size - 0.5 * edge) }
    }

    fn slopes(&self, x: f64) -> Slopes {
        Slopes::smooth(self.stiffness * x.clamp(-self.edge, self.edge))
    }
    fn slope_bounds(&self, low: f64, high: f64) -> Option<Interval> {
        convex_bounds(self, low, high)
    }
}
