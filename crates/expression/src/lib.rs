//! Functions of one variable x, as people write them in configuration: `0.4 * sin(2*pi*x / 3)`.
//!
//! An [`Expression`] gives its value, its derivatives up to the third by forward differentiation in Taylor arithmetic
//! ([`Taylor`]), and, by the same arithmetic over intervals with outward rounding ([`Interval`]), enclosures of value
//! and derivatives over whole ranges of x. All is computed by IEEE operations and `libm`: the same bits everywhere.
//!
//! [`Expression::rough_points`] tells where on a range the function is not smooth: poles, jumps, kinks. What it does not
//! name is proved to be twice differentiable.

mod compile;
mod error;
mod evaluate;
mod function;
mod grammar;
mod interval;
mod rough;
mod scalar;
mod taylor;

pub use compile::{CONSTANTS, Expression};
pub use error::{ExpressionError, known_names};
pub use function::Function;
pub use interval::Interval;
pub use rough::{Rough, Roughness};
pub use scalar::Scalar;
pub use taylor::Taylor;
