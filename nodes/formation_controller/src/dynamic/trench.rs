//! The trench functions that the parameter `trench.shape` may name.

use trench_formation::trench::{Conic, Hyperbolic, Quadratic, Saturated, Slopes, SquareRoot, Trench};

/// A trench chosen while running.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum AnyTrench {
    /// Example 5.2.2.
    Hyperbolic(Hyperbolic),
    /// Example 5.2.1, m = 2.
    Quadratic(Quadratic),
    /// Phi_2 of 5.6.
    Saturated(Saturated),
    /// Example 5.2.1, m = 1.
    Conic(Conic),
    /// F_2 of Example 5.2.3.
    SquareRoot(SquareRoot),
}

/// The names `trench.shape` may have.
pub(crate) const SHAPES: &str = "one of: hyperbolic, quadratic, saturated, conic, square_root";

impl AnyTrench {
    /// The trench of this name: a pull of up to `alpha` (m/s^2), a bottom of width `a` (m). None for other names.
    pub(crate) fn named(name: &str, alpha: f64, a: f64) -> Option<Self> {
        Some(match name {
            "hyperbolic" => Self::Hyperbolic(Hyperbolic { alpha, a }),
            "quadratic" => Self::Quadratic(Quadratic { alpha: alpha / a }),
            "saturated" => Self::Saturated(Saturated { stiffness: alpha / a, edge: a }),
            "conic" => Self::Conic(Conic { alpha }),
            "square_root" => Self::SquareRoot(SquareRoot),
            _ => return None,
        })
    }

    fn chosen(&self) -> &dyn Trench {
        match self {
            Self::Hyperbolic(trench) => trench,
            Self::Quadratic(trench) => trench,
            Self::Saturated(trench) => trench,
            Self::Conic(trench) => trench,
            Self::SquareRoot(trench) => trench,
        }
    }
}

impl Trench for AnyTrench {
    fn value(&self, x: f64) -> f64 {
        self.chosen().value(x)
    }

    fn slopes(&self, x: f64) -> Slopes {
        self.chosen().slopes(x)
    }

    fn kinks(&self) -> Vec<f64> {
        self.chosen().kinks()
    }
}
