//! Potential trench functions of 5.2 and A.9.
//!
//! With d = |r_goal - r| a trench Phi pulls a robot by +Phi'(d) along the unit vector towards its goal point.
mod admissibility;
mod any;
mod conic;
mod critical;
mod damping;
mod hyperbolic;
mod quadratic;
mod saturated;
mod square_root;
mod steepest;
mod table;
mod written;
mod written_damping;

pub use admissibility::{Admissible, Inadmissible, check_admissibility};
pub use any::AnyTrench;
pub use conic::Conic;
pub use critical::CriticallyDamped;
pub use damping::{AnyDamping, ConstantDamping, Damping, HyperbolicDamping, SaturatedDamping};
pub use hyperbolic::Hyperbolic;
pub use quadratic::Quadratic;
pub use saturated::Saturated;
pub use square_root::SquareRoot;
pub use table::{SlopeTable, TableError};
pub use trench_expression::Interval;
pub use written::{Meaning, Written, WrittenError};
pub use written_damping::{DampingError, TableDamping, WrittenDamping};

/// The limits of a derivative from the left and from the right; equal except at kinks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slopes {
    /// From below.
    pub left: f64,
    /// From above.
    pub right: f64,
}

impl Slopes {
    /// Where the function is differentiable.
    pub fn smooth(slope: f64) -> Self {
        Self { left: slope, right: slope }
    }

    /// Lemma 5.2.1 (2) with its ends the right way round.
    pub fn gradient(self) -> Interval {
        Interval { low: self.left.min(self.right), high: self.left.max(self.right) }
    }
}

/// A candidate of Definition 5.2.1, Phi: R -> R.
pub trait Trench {
    /// Phi(x), m^2/s^2 for x in metres.
    fn value(&self, x: f64) -> f64;

    /// The one-sided derivatives phi(x-) and phi(x+), m/s^2.
    fn slopes(&self, x: f64) -> Slopes;

    /// Where the two may differ, and where phi has corners a sampler could miss; in rising order.
    fn kinks(&self) -> Vec<f64> {
        Vec::new()
    }

    /// An interval with all slopes between `low` and `high`, if the trench can tell: what is shown by it holds everywhere.
    fn slope_bounds(&self, _low: f64, _high: f64) -> Option<Interval> {
        None
    }

    /// Clarke's generalized gradient at x.
    fn gradient(&self, x: f64) -> Interval {
        self.slopes(x).gradient()
    }

    /// The element of the gradient that a controller applies: the least, so that a robot on the bottom stays there.
    fn slope(&self, x: f64) -> f64 {
        self.gradient(x).smallest()
    }
}

/// [`Trench::slope_bounds`] of a convex trench, whose slope never falls.
fn convex_bounds(trench: &impl Trench, low: f64, high: f64) -> Option<Interval> {
    Some(Interval { low: trench.slopes(low).left, high: trench.slopes(high).right })
}

impl<T: Trench + ?Sized> Trench for &T {
    fn value(&self, x: f64) -> f64 {
        (**self).value(x)
    }

    fn slopes(&self, x: f64) -> Slopes {
        (**self).slopes(x)
    }

    fn kinks(&self) -> Vec<f64> {
        (**self).kinks()
    }

    fn slope_bounds(&self, low: f64, high: f64) -> Option<Interval> {
        (**self).slope_bounds(low, high)
    }

    fn gradient(&self, x: f64) -> Interval {
        (**self).gradient(x)
    }

    fn slope(&self, x: f64) -> f64 {
        (**self).slope(x)
    }
}
