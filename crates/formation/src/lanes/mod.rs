//! Numbers and vectors of the plane side by side: what one vector instruction does to all of them. Lane by lane the results are
//! those of scalar code that does the same in the same order, bit for bit; what is written for any [`Number`] is that code for both.
use crate::Vector2;
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};
use wide::f64x4;

#[cfg(target_arch = "x86_64")]
mod avx;
mod portable;

#[cfg(all(test, target_arch = "x86_64"))]
pub(crate) use avx::HIDDEN;

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

/// As many numbers side by side as [`LANES`]; a mask is such numbers, of bits that are all set or none.
pub(crate) trait Lanes:
    Number<Vector = Vectors<Self>, Mask = Self> + BitAnd<Output = Self> + BitOr<Output = Self>
{
    fn new(numbers: [f64; LANES]) -> Self;
    fn to_array(self) -> [f64; LANES];
    fn is_not(self, other: Self) -> Self;
    /// The lesser of each, `other` where they are equal.
    fn least(self, other: Self) -> Self;
    /// The greater of each, `other` where they are equal.
    fn most(self, other: Self) -> Self;
    fn magnitude(self) -> Self;
    /// A bit for each lane in which a mask is set.
    fn bits(self) -> u32;

    /// A mask from a condition for each lane.
    #[inline(always)]
    fn mask(lanes: [bool; LANES]) -> Self {
        Self::new(lanes.map(|lane| f64::from_bits(if lane { u64::MAX } else { 0 })))
    }

    /// Whether a mask is set in all lanes.
    #[inline(always)]
    fn is_whole(self) -> bool {
        self.bits() == (1 << LANES) - 1
    }
}

/// What is done in lanes of any kind, bit for bit alike.
pub(crate) trait Work {
    type Output;
    /// To be `#[inline(always)]`, and all that is generic over the lanes in it: see [`in_widest`].
    fn in_lanes<L: Lanes>(self) -> Self::Output;
}

/// Does work in the widest lanes that this processor has.
#[inline]
pub(crate) fn in_widest<W: Work>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    if avx::Avx::is_there() {
        #[expect(unsafe_code, reason = "this processor has the instructions")]
        return unsafe { avx::run(work) };
    }
    work.in_lanes::<f64x4>()
}

/// Where a value is first found in lanes that lie one after the other.
#[inline(always)]
pub(crate) fn first_at<L: Lanes>(all: impl Iterator<Item = L>, value: f64) -> Option<usize> {
    for (index, lanes) in all.enumerate() {
        let others = lanes.is_not(L::splat(value));
        if !others.is_whole() {
            return Some(LANES * index + others.bits().trailing_ones() as usize);
        }
    }
    None
}

/// A vector in each lane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Vectors<L> {
    pub(crate) x: L,
    pub(crate) y: L,
}

impl<L: Lanes> Vectors<L> {
    #[inline(always)]
    pub(crate) fn of(vectors: [Vector2<f64>; LANES]) -> Self {
        Self { x: L::new(vectors.map(|vector| vector.x)), y: L::new(vectors.map(|vector| vector.y)) }
    }

    #[inline(always)]
    pub(crate) fn to_array(self) -> [Vector2<f64>; LANES] {
        let (x, y) = (self.x.to_array(), self.y.to_array());
        core::array::from_fn(|lane| Vector2::new(x[lane], y[lane]))
    }

    /// Lanes of `self` where `mask` is set, of `other` elsewhere.
    #[inline(always)]
    pub(crate) fn or(&self, mask: L, other: &Self) -> Self {
        Self { x: self.x.or(mask, other.x), y: self.y.or(mask, other.y) }
    }
}

impl<L: Lanes> Plane for Vectors<L> {
    type Number = L;

    #[inline(always)]
    fn splat(vector: Vector2<f64>) -> Self {
        Self { x: L::splat(vector.x), y: L::splat(vector.y) }
    }

    #[inline(always)]
    fn dot(&self, other: &Self) -> L {
        self.x * other.x + self.y * other.y
    }
}

impl<L: Lanes> Add for Vectors<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y }
    }
}

impl<L: Lanes> Sub for Vectors<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y }
    }
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
