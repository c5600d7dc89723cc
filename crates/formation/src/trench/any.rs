//! A trench that is chosen while the program runs: by a parameter or a scenario file.
use super::{
    AnyDamping, Conic, CriticallyDamped, Hyperbolic, Interval, Quadratic, Saturated, SlopeTable, Slopes, SquareRoot,
    Trench, Written,
};

/// One of the trenches of this module.
#[derive(Debug, Clone, PartialEq)]
pub enum AnyTrench {
    /// Example 5.2.1, m = 1.
    Conic(Conic),
    /// Example 5.2.1, m = 2.
    Quadratic(Quadratic),
    /// Example 5.2.2.
    Hyperbolic(Hyperbolic),
    /// Phi_2 of 5.6.
    Saturated(Saturated),
    /// F_2 of Example 5.2.3.
    SquareRoot(SquareRoot),
    /// Corollary A.9.1.
    Critical(CriticallyDamped<AnyDamping>),
    /// Lemma 5.2.1.
    Table(SlopeTable),
    /// A formula.
    Written(Box<Written>),
}

impl AnyTrench {
    fn chosen(&self) -> &dyn Trench {
        match self {
            Self::Conic(trench) => trench,
            Self::Quadratic(trench) => trench,
            Self::Hyperbolic(trench) => trench,
            Self::Saturated(trench) => trench,
            Self::SquareRoot(trench) => trench,
            Self::Critical(trench) => trench,
            Self::Table(trench) => trench,
            Self::Written(trench) => &**trench,
        }
    }
}

impl Trench for AnyTrench {
    #[inline]
    fn value(&self, x: f64) -> f64 {
        match self {
            Self::Hyperbolic(trench) => trench.value(x),
            other => other.chosen().value(x),
        }
    }

    fn slopes(&self, x: f64) -> Slopes {
        self.chosen().slopes(x)
    }

    /// A robot asks for it and for the value at every step, most of them of the trench of the thesis's simulations.
    #[inline]
    fn slope(&self, x: f64) -> f64 {
        match self {
            Self::Hyperbolic(trench) => trench.slope(x),
            other => other.chosen().slope(x),
        }
    }

    fn kinks(&self) -> Vec<f64> {
        self.chosen().kinks()
    }

    fn slope_bounds(&self, low: f64, high: f64) -> Option<Interval> {
        self.chosen().slope_bounds(low, high)
    }
}
