//! Numbers and vectors of the plane side by side: what one vector instruction does to all of them. Lane by lane the results are
//! those of scalar code that does the same in the same order, bit for bit; what is written for any [`Number`] is that code for both.
use crate::Vector2;
use core::ops::{Add, BitAnd, Div, Mul, Neg, Sub};
use wide::f64x4;

/// How many.
pub(crate) const LANES: usize = 4;

/// A number, or several side by side.
pub(crate) trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Mul<Self::Vector, Output = Self::Vector>
{
    /// As many vectors.
    type Vector: Plane<Number = Self>;
    /// As many conditions.
    type Mask: Copy + BitAnd<Output = Self::Mask>;
    /// The same everywhere.
    fn splat(number: f64) -> Self;
    fn is_below(self, other: Self) -> Self::Mask;
    fn is_at_most(self, other: Self) -> Self::Mask;
    /// `self` where `mask` is set, `other` elsewhere.
    fn or(self, mask: Self::Mask, other: Self) -> Self;
    /// A function of each.
    fn each(self, function: impl Fn(f64) -> f64) -> Self;
    fn root(self) -> Self;
}

/// A vector of the plane, or several side by side.
pub(crate) trait Plane: Copy + Add<Output = Self> + Sub<Output = Self> {
    type Number: Number<Vector = Self>;
    /// The same everywhere.
    fn splat(vector: Vector2<f64>) -> Self;
    fn dot(&self, other: &Self) -> Self::Number;

    #[inline(always)]
    fn norm_squared(&self) -> Self::Number {
        Plane::dot(self, self)
    }

    #[inline(always)]
    fn norm(&self) -> Self::Number {
        Plane::norm_squared(self).root()
    }
}

impl Number for f64 {
    type Vector = Vector2<f64>;
    type Mask = bool;

    #[inline(always)]
    fn splat(number: f64) -> Self {
        number
    }

    #[inline(always)]
    fn is_below(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn is_at_most(self, other: Self) -> bool {
        self <= other
    }

    #[inline(always)]
    fn or(self, mask: bool, other: Self) -> Self {
        if mask { self } else { other }
    }

    #[inline(always)]
    fn each(self, function: impl Fn(f64) -> f64) -> Self {
        function(self)
    }

    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }
}

impl Plane for Vector2<f64> {
    type Number = f64;

    #[inline(always)]
    fn splat(vector: Self) -> Self {
        vector
    }

    #[inline(always)]
    fn dot(&self, other: &Self) -> f64 {
        self.x * other.x + self.y * other.y
    }
}

impl Number for f64x4 {
    type Vector = Vectors;
    type Mask = Self;

    #[inline(always)]
    fn splat(number: f64) -> Self {
        Self::splat(number)
    }

    #[inline(always)]
    fn is_below(self, other: Self) -> Self {
        self.simd_lt(other)
    }

    #[inline(always)]
    fn is_at_most(self, other: Self) -> Self {
        self.simd_le(other)
    }

    #[inline(always)]
    fn or(self, mask: Self, other: Self) -> Self {
        mask.select(self, other)
    }

    #[inline(always)]
    fn each(self, function: impl Fn(f64) -> f64) -> Self {
        Self::new(self.to_array().map(function))
    }

    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }
}

/// A vector in each lane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Vectors {
    pub(crate) x: f64x4,
    pub(crate) y: f64x4,
}

impl Vectors {
    #[inline(always)]
    pub(crate) fn of(vectors: [Vector2<f64>; LANES]) -> Self {
        Self { x: f64x4::new(vectors.map(|vector| vector.x)), y: f64x4::new(vectors.map(|vector| vector.y)) }
    }

    #[inline(always)]
    pub(crate) fn get(&self, lane: usize) -> Vector2<f64> {
        Vector2::new(self.x.as_array()[lane], self.y.as_array()[lane])
    }

    /// Lanes of `self` where `mask` is set, of `other` elsewhere.
    #[inline(always)]
    pub(crate) fn or(&self, mask: f64x4, other: &Self) -> Self {
        Self { x: mask.select(self.x, other.x), y: mask.select(self.y, other.y) }
    }
}

impl Plane for Vectors {
    type Number = f64x4;

    #[inline(always)]
    fn splat(vector: Vector2<f64>) -> Self {
        Self { x: f64x4::splat(vector.x), y: f64x4::splat(vector.y) }
    }

    #[inline(always)]
    fn dot(&self, other: &Self) -> f64x4 {
        self.x * other.x + self.y * other.y
    }
}

impl Add for Vectors {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y }
    }
}

impl Sub for Vectors {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y }
    }
}

impl Mul<Vectors> for f64x4 {
    type Output = Vectors;
    #[inline(always)]
    fn mul(self, vectors: Vectors) -> Vectors {
        Vectors { x: self * vectors.x, y: self * vectors.y }
    }
}

/// A mask from a condition for each lane.
#[inline(always)]
pub(crate) fn mask(lanes: [bool; LANES]) -> f64x4 {
    f64x4::new(lanes.map(|lane| f64::from_bits(if lane { u64::MAX } else { 0 })))
}

/// Lets the beginning of what will be read soon come nearer to the processor, without waiting for it.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(crate) fn call_for<T>(value: &T) {
    safe_arch::prefetch_t0(value);
}

/// Elsewhere it comes when it is read.
#[cfg(not(target_arch = "x86_64"))]
pub(crate) fn call_for<T>(_: &T) {}
