//! Numbers and vectors of the plane side by side: what one vector instruction does to all of them. Lane by lane the results are
//! those of scalar code that does the same in the same order, bit for bit.
use crate::Vector2;
use core::ops::{Add, Mul, Sub};
use wide::f64x4;

/// How many.
pub(crate) const LANES: usize = 4;

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

    /// The same in all lanes.
    #[inline(always)]
    pub(crate) fn splat(vector: Vector2<f64>) -> Self {
        Self { x: f64x4::splat(vector.x), y: f64x4::splat(vector.y) }
    }

    #[inline(always)]
    pub(crate) fn get(&self, lane: usize) -> Vector2<f64> {
        Vector2::new(self.x.as_array()[lane], self.y.as_array()[lane])
    }

    #[inline(always)]
    pub(crate) fn dot(&self, other: &Self) -> f64x4 {
        self.x * other.x + self.y * other.y
    }

    #[inline(always)]
    pub(crate) fn norm_squared(&self) -> f64x4 {
        self.dot(self)
    }

    #[inline(always)]
    pub(crate) fn norm(&self) -> f64x4 {
        self.norm_squared().sqrt()
    }

    /// Lanes of `self` where `mask` is set, of `other` elsewhere.
    #[inline(always)]
    pub(crate) fn or(&self, mask: f64x4, other: &Self) -> Self {
        Self { x: mask.select(self.x, other.x), y: mask.select(self.y, other.y) }
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
