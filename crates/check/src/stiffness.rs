//! How stiff a trench is at its bottom, and how steep it is anywhere.

use trench_formation::trench::{AnyTrench, Trench, check_admissibility};

/// m from the bottom, where its slope is looked at.
const BESIDE: f64 = 1e-6;
/// Share by which the slope over the distance may differ twice as near to the bottom.
const LINEAR: f64 = 0.01;

/// Phi''(0), 1/s^2, of a trench of any shape: what the queue law needs, which is linear. None of trenches with a kink at their bottom, and of
/// those that are flat there (whose slope falls faster than the distance).
pub(crate) fn stiffness(trench: &dyn Trench) -> Option<f64> {
    let bottom = trench.slopes(0.0);
    let [near, nearer] = [BESIDE, 0.5 * BESIDE].map(|distance| trench.slopes(distance).right / distance);
    let is_linear = bottom.left == bottom.right && (near - nearer).abs() <= LINEAR * near;
    (is_linear && near > 0.0).then_some(near)
}

/// The largest slope of a trench, its pull in m/s^2, up to `range` (m); infinite of one that is not admissible.
pub(crate) fn steepest(trench: &AnyTrench, range: f64) -> f64 {
    check_admissibility(trench, range).map_or(f64::INFINITY, |found| found.lipschitz_constant)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_formation::trench::{Conic, Hyperbolic, Quadratic, SlopeTable};

    fn check(trench: &dyn Trench, expected: Option<f64>) {
        let near = |found: f64| expected.is_some_and(|expected| (found - expected).abs() <= 1e-9 * expected);
        let found = stiffness(trench);
        assert!(found.map_or(expected.is_none(), near), "{found:?}, not {expected:?}");
    }

    #[test]
    fn of_all_shapes() {
        check(&Hyperbolic { alpha: 0.5, a: 0.2 }, Some(2.5));
        check(&Quadratic { alpha: 3.0 }, Some(Quadratic { alpha: 3.0 }.slope(1.0)));
        check(&Conic { alpha: 1.0 }, None);
        check(&SlopeTable::new(vec![(0.0, 0.0), (0.5, 1.0), (2.0, 1.0)]).unwrap(), Some(2.0));
    }
}
