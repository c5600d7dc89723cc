//! Intervals with outward rounding (R. E. Moore, R. B. Kearfott, M. J. Cloud, *Introduction to Interval Analysis*, 2009).
//!
//! Every result contains all values that the operation can have on its operands: sums and products are rounded outward by
//! one unit in the last place, results of `libm` by four. Whatever is not defined on all of an operand is unbounded.
use crate::Scalar;
use core::f64::consts::{FRAC_PI_2, PI, TAU};
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A closed interval. Of a function's slopes it is Clarke's generalized gradient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Beyond this no multiple of pi is known well enough.
const FAR: f64 = 1e9;

impl Interval {
    /// All numbers, and nothing at all: what nothing is known of.
    pub const UNBOUNDED: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// From its ends; unbounded if they are no numbers or the wrong way round.
    pub fn new(low: f64, high: f64) -> Self {
        if low <= high { Self { low, high } } else { Self::UNBOUNDED }
    }

    /// Whether `value` lies in it.
    pub fn contains(self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// Whether both ends are finite.
    pub fn is_bounded(self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    /// Its element nearest to 0.
    pub fn smallest(self) -> f64 {
        if self.contains(0.0) {
            0.0
        } else if self.low > 0.0 {
            self.low
        } else {
            self.high
        }
    }

    /// The greatest magnitude in it.
    pub fn magnitude(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Rounded outward by one unit in the last place.
    fn widened(low: f64, high: f64) -> Self {
        Self::new(low.next_down(), high.next_up())
    }

    /// From the values of a rising function at the ends, as `libm` gives them.
    fn rising(self, function: fn(f64) -> f64) -> Self {
        let (mut low, mut high) = (function(self.low), function(self.high));
        for _ in 0..4 {
            (low, high) = (low.next_down(), high.next_up());
        }
        Self::new(low, high)
    }

    /// Within [low, high], where the function's values lie.
    fn within(self, low: f64, high: f64) -> Self {
        Self::new(self.low.clamp(low, high), self.high.clamp(low, high))
    }

    /// Whether some `offset` + n `period` may lie in it.
    fn may_meet(self, offset: f64, period: f64) -> bool {
        let slack = 1e-15 * (1.0 + self.magnitude());
        let turns = libm::ceil((self.low - slack - offset) / period - 1e-12);
        offset + turns * period <= self.high + 2.0 * slack
    }

    fn cosine(self) -> Self {
        if self.magnitude() > FAR || self.high - self.low >= TAU {
            return Self { low: -1.0, high: 1.0 };
        }
        let (first, second) = (libm::cos(self.low), libm::cos(self.high));
        let ends = Self { low: first.min(second), high: first.max(second) }.rising(|value| value).within(-1.0, 1.0);
        Self {
            low: if self.may_meet(PI, TAU) { -1.0 } else { ends.low },
            high: if self.may_meet(0.0, TAU) { 1.0 } else { ends.high },
        }
    }

    fn sine(self) -> Self {
        if self.magnitude() > FAR || self.high - self.low >= TAU {
            return Self { low: -1.0, high: 1.0 };
        }
        let (first, second) = (libm::sin(self.low), libm::sin(self.high));
        let ends = Self { low: first.min(second), high: first.max(second) }.rising(|value| value).within(-1.0, 1.0);
        Self {
            low: if self.may_meet(-FRAC_PI_2, TAU) { -1.0 } else { ends.low },
            high: if self.may_meet(FRAC_PI_2, TAU) { 1.0 } else { ends.high },
        }
    }
}

impl Add for Interval {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        if other.is_zero() {
            return self;
        }
        if self.is_zero() {
            return other;
        }
        Self::widened(self.low + other.low, self.high + other.high)
    }
}

impl Sub for Interval {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Interval {
    type Output = Self;

    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl Mul for Interval {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        // Exactly: what does not change with x has derivatives that are exactly 0.
        if (self.is_zero() && other.is_bounded()) || (other.is_zero() && self.is_bounded()) {
            return Self::constant(0.0);
        }
        let products = [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        if products.iter().any(|product| product.is_nan()) {
            return Self::UNBOUNDED;
        }
        let low = products.iter().copied().fold(f64::INFINITY, f64::min);
        let high = products.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut result = Self::widened(low, high);
        // Rounding never takes a product across 0.
        if low >= 0.0 {
            result.low = result.low.max(0.0);
        }
        if high <= 0.0 {
            result.high = result.high.min(0.0);
        }
        result
    }
}

impl Div for Interval {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        if other.contains(0.0) || !other.is_bounded() {
            return Self::UNBOUNDED;
        }
        if self.is_zero() {
            return self;
        }
        self * Self::widened(1.0 / other.high, 1.0 / other.low)
    }
}

impl Scalar for Interval {
    fn constant(value: f64) -> Self {
        Self { low: value, high: value }
    }

    fn unknown() -> Self {
        Self::UNBOUNDED
    }

    fn either(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn sign(self) -> Option<bool> {
        if self.low >= 0.0 {
            Some(true)
        } else if self.high <= 0.0 {
            Some(false)
        } else {
            None
        }
    }

    fn is_zero(self) -> bool {
        self.low == 0.0 && self.high == 0.0
    }

    fn abs(self) -> Self {
        match self.sign() {
            Some(true) => self,
            Some(false) => -self,
            None => Self { low: 0.0, high: self.magnitude() },
        }
    }

    fn min(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.min(other.high) }
    }

    fn square(self) -> Self {
        let size = self.abs();
        size * size
    }

    fn power(self, exponent: i32) -> Self {
        let base = if exponent % 2 == 0 { self.abs() } else { self };
        let (mut rest, mut factor, mut result) = (exponent.unsigned_abs(), base, Self::constant(1.0));
        while rest > 0 {
            if rest & 1 == 1 {
                result = result * factor;
            }
            factor = factor.square();
            rest >>= 1;
        }
        if exponent < 0 { Self::constant(1.0) / result } else { result }
    }

    fn real_power(self, exponent: f64) -> Self {
        let positive = if exponent > 0.0 { self.low >= 0.0 } else { self.low > 0.0 };
        if !positive || !self.is_bounded() {
            return Self::UNBOUNDED;
        }
        let (first, second) = (libm::pow(self.low, exponent), libm::pow(self.high, exponent));
        let ends = Self { low: first.min(second), high: first.max(second) }.rising(|value| value);
        Self { low: ends.low.max(0.0), high: ends.high }
    }

    fn sqrt(self) -> Self {
        if self.low < 0.0 {
            return Self::UNBOUNDED;
        }
        let root = Self::widened(self.low.sqrt(), self.high.sqrt());
        Self { low: root.low.max(0.0), high: root.high }
    }

    fn exponential(self) -> Self {
        let value = self.rising(libm::exp);
        Self { low: value.low.max(0.0), high: value.high }
    }

    fn logarithm(self) -> Self {
        if self.low > 0.0 { self.rising(libm::log) } else { Self::UNBOUNDED }
    }

    fn sine_cosine(self) -> (Self, Self) {
        if self.is_bounded() { (self.sine(), self.cosine()) } else { (Self::UNBOUNDED, Self::UNBOUNDED) }
    }

    fn tangent(self) -> Self {
        if self.magnitude() > FAR || self.high - self.low >= PI || self.may_meet(FRAC_PI_2, PI) {
            return Self::UNBOUNDED;
        }
        self.rising(libm::tan)
    }

    fn arc_sine(self) -> Self {
        if self.low >= -1.0 && self.high <= 1.0 { self.rising(libm::asin) } else { Self::UNBOUNDED }
    }

    fn arc_cosine(self) -> Self {
        if self.low >= -1.0 && self.high <= 1.0 { (-self).rising(|value| libm::acos(-value)) } else { Self::UNBOUNDED }
    }

    fn arc_tangent(self) -> Self {
        if self.is_bounded() { self.rising(libm::atan) } else { Self::UNBOUNDED }
    }

    fn hyperbolic_sine(self) -> Self {
        self.rising(libm::sinh)
    }

    fn hyperbolic_cosine(self) -> Self {
        let value = self.abs().rising(libm::cosh);
        Self { low: value.low.max(1.0), high: value.high }
    }

    fn hyperbolic_tangent(self) -> Self {
        if self.is_bounded() { self.rising(libm::tanh).within(-1.0, 1.0) } else { Self::UNBOUNDED }
    }
}
