//! Lanes as whatever the build may rely on: two halves in registers of SSE2 or NEON.
use super::{LANES, Lanes, Number, Vectors};
use core::ops::Mul;
use wide::f64x4;

impl Number for f64x4 {
    type Vector = Vectors<Self>;
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

impl Lanes for f64x4 {
    #[inline(always)]
    fn new(numbers: [f64; LANES]) -> Self {
        Self::new(numbers)
    }

    #[inline(always)]
    fn to_array(self) -> [f64; LANES] {
        self.to_array()
    }

    #[inline(always)]
    fn is_not(self, other: Self) -> Self {
        self.simd_ne(other)
    }

    #[inline(always)]
    fn least(self, other: Self) -> Self {
        self.fast_min(other)
    }

    #[inline(always)]
    fn most(self, other: Self) -> Self {
        self.fast_max(other)
    }

    #[inline(always)]
    fn magnitude(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn bits(self) -> u32 {
        self.to_bitmask()
    }
}

impl Mul<Vectors<Self>> for f64x4 {
    type Output = Vectors<Self>;
    #[inline(always)]
    fn mul(self, vectors: Vectors<Self>) -> Vectors<Self> {
        Vectors { x: self * vectors.x, y: self * vectors.y }
    }
}
