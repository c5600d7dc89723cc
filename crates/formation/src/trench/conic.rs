//! Example 5.2.1 with m = 1.
use super::{Interval, Slopes, Trench, convex_bounds};

/// Phi = alpha |x|: the same pull from everywhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conic {
    /// m/s^2.
    pub alpha: f64,
}

impl Trench for Conic {
    fn value(&self, x: f64) -> f64 {
        self.alpha * x.abs()
    }

    fn slopes(&self, x: f64) -> Slopes {
        Slopes {
            left: if x > 0.0 { self.alpha } else { -self.alpha },
            right: if x < 0.0 { -self.alpha } else { self.alpha },
        }
    }

    fn kinks(&self) -> Vec<f64> {
        vec![0.0]
    }
    fn slope_bounds(&self, low: f64, high: f64) -> Option<Interval> {
        convex_bounds(self, low, high)
    }
}
