//! The trench functions that the parameter `trench.shape` may name.

use trench_formation::trench::{AnyTrench, Conic, Hyperbolic, Quadratic, Saturated, SquareRoot};

/// The names `trench.shape` may have.
pub(crate) const SHAPES: &str = "one of: hyperbolic, quadratic, saturated, conic, square_root";

/// The trench of this name: a pull of up to `alpha` (m/s^2), a bottom of width `a` (m). None for other names.
pub(crate) fn named(name: &str, alpha: f64, a: f64) -> Option<AnyTrench> {
    Some(match name {
        "hyperbolic" => AnyTrench::Hyperbolic(Hyperbolic { alpha, a }),
        "quadratic" => AnyTrench::Quadratic(Quadratic { alpha: alpha / a }),
        "saturated" => AnyTrench::Saturated(Saturated { stiffness: alpha / a, edge: a }),
        "conic" => AnyTrench::Conic(Conic { alpha }),
        "square_root" => AnyTrench::SquareRoot(SquareRoot),
        _ => return None,
    })
}
