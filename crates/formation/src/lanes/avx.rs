//! Lanes in one register of AVX, for processors that have it, found out when the program runs.
#![expect(unsafe_code, reason = "instructions that not every processor has: who uses them asks `Avx::is_there` first")]
use super::{LANES, Lanes, Number, Vectors, Work};
use core::arch::x86_64::{
    __m256d, _CMP_LE_OQ, _CMP_LT_OQ, _CMP_NEQ_UQ, _mm256_add_pd, _mm256_and_pd, _mm256_andnot_pd, _mm256_blendv_pd,
    _mm256_cmp_pd, _mm256_div_pd, _mm256_loadu_pd, _mm256_max_pd, _mm256_min_pd, _mm256_movemask_pd, _mm256_mul_pd,
    _mm256_or_pd, _mm256_set1_pd, _mm256_sqrt_pd, _mm256_storeu_pd, _mm256_sub_pd, _mm256_xor_pd,
};
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

/// Four numbers. To be used where [`Avx::is_there`], and in what a function with `#[target_feature(enable = "avx2")]` calls and
/// `#[inline(always)]` puts into it: elsewhere each operation is a call.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Avx(__m256d);

impl Avx {
    /// Whether this processor has it.
    #[inline]
    pub(crate) fn is_there() -> bool {
        #[cfg(test)]
        if HIDDEN.get() {
            return false;
        }
        std::arch::is_x86_feature_detected!("avx2")
    }
}

/// Work in these lanes.
#[target_feature(enable = "avx2")]
pub(super) fn run<W: Work>(work: W) -> W::Output {
    work.in_lanes::<Avx>()
}

#[cfg(test)]
std::thread_local! {
    /// Lets a test go without it.
    pub(crate) static HIDDEN: core::cell::Cell<bool> = const { core::cell::Cell::new(false) };
}

/// Operators of one instruction.
macro_rules! operators {
    ($($trait:ident $method:ident $instruction:ident)*) => {
        $(impl $trait for Avx {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: as `Avx` says.
                Self(unsafe { $instruction(self.0, other.0) })
            }
        })*
    };
}
operators! {
    Add add _mm256_add_pd
    Sub sub _mm256_sub_pd
    Mul mul _mm256_mul_pd
    Div div _mm256_div_pd
    BitAnd bitand _mm256_and_pd
    BitOr bitor _mm256_or_pd
}

impl Neg for Avx {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: as `Avx` says.
        Self(unsafe { _mm256_xor_pd(self.0, _mm256_set1_pd(-0.0)) })
    }
}

impl Mul<Vectors<Self>> for Avx {
    type Output = Vectors<Self>;
    #[inline(always)]
    fn mul(self, vectors: Vectors<Self>) -> Vectors<Self> {
        Vectors { x: self * vectors.x, y: self * vectors.y }
    }
}

impl Number for Avx {
    type Vector = Vectors<Self>;
    type Mask = Self;

    #[inline(always)]
    fn splat(number: f64) -> Self {
        // SAFETY: as `Avx` says.
        Self(unsafe { _mm256_set1_pd(number) })
    }

    #[inline(always)]
    fn is_below(self, other: Self) -> Self {
        // SAFETY: as `Avx` says.
        Self(unsafe { _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn is_at_most(self, other: Self) -> Self {
        // SAFETY: as `Avx` says.
        Self(unsafe { _mm256_cmp_pd::<_CMP_LE_OQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn or(self, mask: Self, other: Self) -> Self {
        // SAFETY: as `Avx` says.
        Self(unsafe { _mm256_blendv_pd(other.0, self.0, mask.0) })
    }

    #[inline(always)]
    fn each(self, function: impl Fn(f64) -> f64) -> Self {
        Self::new(self.to_array().map(function))
    }

    #[inline(always)]
    fn root(self) -> Self {
        // SAFETY: as `Avx` says.
        Self(unsafe { _mm256_sqrt_pd(self.0) })
    }
}

impl Lanes for Avx {
    #[inline(always)]
    fn new(numbers: [f64; LANES]) -> Self {
        // SAFETY: as `Avx` says; four numbers are read.
        Self(unsafe { _mm256_loadu_pd(numbers.as_ptr()) })
    }

    #[inline(always)]
    fn to_array(self) -> [f64; LANES] {
        let mut numbers = [0.0; LANES];
        // SAFETY: as `Avx` says; four numbers are written.
        unsafe { _mm256_storeu_pd(numbers.as_mut_ptr(), self.0) };
        numbers
    }

    #[inline(always)]
    fn is_not(self, other: Self) -> Self {
        // SAFETY: as `Avx` says.
        Self(unsafe { _mm256_cmp_pd::<_CMP_NEQ_UQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn least(self, other: Self) -> Self {
        // SAFETY: as `Avx` says.
        Self(unsafe { _mm256_min_pd(self.0, other.0) })
    }

    #[inline(always)]
    fn most(self, other: Self) -> Self {
        // SAFETY: as `Avx` says.
        Self(unsafe { _mm256_max_pd(self.0, other.0) })
    }

    #[inline(always)]
    fn magnitude(self) -> Self {
        // SAFETY: as `Avx` says.
        Self(unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0) })
    }

    #[inline(always)]
    fn bits(self) -> u32 {
        // SAFETY: as `Avx` says.
        unsafe { _mm256_movemask_pd(self.0) as u32 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::Plane;
    use proptest::prelude::*;
    use wide::f64x4;

    /// What can be done with two numbers, in four lanes of any kind.
    fn all<L: Lanes>(a: [f64; LANES], b: [f64; LANES]) -> Vec<[u64; LANES]> {
        let (a, b) = (L::new(a), L::new(b));
        let (x, y) = (Vectors { x: a, y: b }, Vectors { x: b, y: L::splat(0.1) });
        let masks = [
            a.is_below(b),
            a.is_at_most(b),
            a.is_not(b),
            a.is_below(b) | b.is_below(a),
            a.is_at_most(b) & b.is_at_most(a),
        ];
        let chosen = masks.map(|mask| a.or(mask, b));
        let bits = masks.map(|mask| L::splat(f64::from(mask.bits()) + f64::from(u8::from(mask.is_whole()))));
        let numbers = [
            a + b,
            a - b,
            a * b,
            a / b,
            -a,
            a.least(b),
            a.most(b),
            a.magnitude(),
            a.root(),
            a.each(libm::sin),
            Plane::dot(&x, &y),
            (a * y).y,
        ];
        let lanes = numbers.into_iter().chain(masks).chain(chosen).chain(bits).chain([x.or(masks[0], &y).x]);
        lanes.map(|lanes| lanes.to_array().map(f64::to_bits)).collect()
    }

    proptest! {
        #[test]
        fn they_are_bit_for_bit_those_of_any_processor(a: [f64; LANES], b: [f64; LANES]) {
            if Avx::is_there() {
                prop_assert_eq!(all::<Avx>(a, b), all::<f64x4>(a, b));
                prop_assert_eq!(all::<Avx>(a, a), all::<f64x4>(a, a));
            }
        }
    }
}
