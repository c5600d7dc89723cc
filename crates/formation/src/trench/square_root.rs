//! F_2 of Example 5.2.3.
use super::{Interval, Slopes, Trench};

/// x^2 for |x| < 1, 4 sqrt|x| - 3 beyond: smooth, not convex, and pulling less from afar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SquareRoot;

impl Trench for SquareRoot {
    fn value(&self, x: f64) -> f64 {
        let size = x.abs();
        if size < 1.0 { x * x } else { 4.0 * size.sqrt() - 3.0 }
    }

    fn slopes(&self, x: f64) -> Slopes {
        let size = x.abs();
        Slopes::smooth(if size < 1.0 { 2.0 * x } else { (2.0 / size.sqrt()).copysign(x) })
    }

    fn kinks(&self) -> Vec<f64> {
        vec![-1.0, 1.0]
    }

    /// Exact: the slope rises to 2 at x = 1 and falls from there on, and is odd.
    fn slope_bounds(&self, low: f64, high: f64) -> Option<Interval> {
        let peaks = [-1.0, 1.0].into_iter().filter(|x| (low..=high).contains(x));
        let slopes = [low, high].into_iter().chain(peaks).map(|x| self.slope(x));
        let hull = |all: Interval, slope: f64| Interval { low: all.low.min(slope), high: all.high.max(slope) };
        Some(slopes.fold(Interval { low: f64::INFINITY, high: f64::NEG_INFINITY }, hull))
    }
}
