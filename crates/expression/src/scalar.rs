//! Numbers that Taylor arithmetic works over.
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number, or an interval that encloses one.
pub trait Scalar:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// What stands for a number.
    fn constant(value: f64) -> Self;
    /// What stands for nothing that could be said.
    fn unknown() -> Self;
    /// What stands for either of two.
    fn either(self, other: Self) -> Self;
    /// Whether it is not below 0 (true), not above (false), or either: none.
    fn sign(self) -> Option<bool>;
    /// Whether it is exactly 0.
    fn is_zero(self) -> bool;
    /// |a|.
    fn abs(self) -> Self;
    /// The lesser of two.
    fn min(self, other: Self) -> Self;
    /// a a.
    fn square(self) -> Self;
    /// a^n.
    fn power(self, exponent: i32) -> Self;
    /// a^r for a >= 0.
    fn real_power(self, exponent: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// e^a.
    fn exponential(self) -> Self;
    /// Natural logarithm.
    fn logarithm(self) -> Self;
    /// Sine and cosine.
    fn sine_cosine(self) -> (Self, Self);
    /// Tangent.
    fn tangent(self) -> Self;
    /// Inverse sine.
    fn arc_sine(self) -> Self;
    /// Inverse cosine.
    fn arc_cosine(self) -> Self;
    /// Inverse tangent.
    fn arc_tangent(self) -> Self;
    /// Hyperbolic sine.
    fn hyperbolic_sine(self) -> Self;
    /// Hyperbolic cosine.
    fn hyperbolic_cosine(self) -> Self;
    /// Hyperbolic tangent.
    fn hyperbolic_tangent(self) -> Self;
}

impl Scalar for f64 {
    fn constant(value: f64) -> Self {
        value
    }

    fn unknown() -> Self {
        f64::NAN
    }

    fn either(self, _: Self) -> Self {
        self
    }

    fn sign(self) -> Option<bool> {
        Some(self >= 0.0)
    }

    fn is_zero(self) -> bool {
        self == 0.0
    }

    fn abs(self) -> Self {
        f64::abs(self)
    }

    fn min(self, other: Self) -> Self {
        f64::min(self, other)
    }

    fn square(self) -> Self {
        self * self
    }

    fn power(self, exponent: i32) -> Self {
        let (mut rest, mut factor, mut result) = (exponent.unsigned_abs(), self, 1.0);
        while rest > 0 {
            if rest & 1 == 1 {
                result *= factor;
            }
            factor *= factor;
            rest >>= 1;
        }
        if exponent < 0 { 1.0 / result } else { result }
    }

    fn real_power(self, exponent: f64) -> Self {
        libm::pow(self, exponent)
    }

    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    fn exponential(self) -> Self {
        libm::exp(self)
    }

    fn logarithm(self) -> Self {
        libm::log(self)
    }

    fn sine_cosine(self) -> (Self, Self) {
        libm::sincos(self)
    }

    fn tangent(self) -> Self {
        libm::tan(self)
    }

    fn arc_sine(self) -> Self {
        libm::asin(self)
    }

    fn arc_cosine(self) -> Self {
        libm::acos(self)
    }

    fn arc_tangent(self) -> Self {
        libm::atan(self)
    }

    fn hyperbolic_sine(self) -> Self {
        libm::sinh(self)
    }

    fn hyperbolic_cosine(self) -> Self {
        libm::cosh(self)
    }

    fn hyperbolic_tangent(self) -> Self {
        libm::tanh(self)
    }
}
