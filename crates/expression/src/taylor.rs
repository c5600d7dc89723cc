//! Forward differentiation: truncated Taylor series instead of numbers (A. Griewank, A. Walther, *Evaluating Derivatives*,
//! 2nd edition, 2008, chapter 13).
use crate::{Function, Scalar};

/// f(x), f'(x), f''(x)/2, f'''(x)/6: the first N of them, N at most 4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Taylor<T, const N: usize>(pub [T; N]);

impl<T: Scalar, const N: usize> Taylor<T, N> {
    /// A number, whose derivatives are 0.
    pub fn constant(value: T) -> Self {
        Self(core::array::from_fn(|order| if order == 0 { value } else { T::constant(0.0) }))
    }

    /// x itself.
    pub fn variable(value: T) -> Self {
        Self(core::array::from_fn(|order| match order {
            0 => value,
            1 => T::constant(1.0),
            _ => T::constant(0.0),
        }))
    }

    /// The derivative of an order below N.
    pub fn derivative(&self, order: usize) -> T {
        match order {
            0 | 1 => self.0[order],
            2 => T::constant(2.0) * self.0[2],
            _ => T::constant(6.0) * self.0[3],
        }
    }

    pub(crate) fn negate(self) -> Self {
        Self(self.0.map(|coefficient| -coefficient))
    }

    pub(crate) fn add(self, other: Self) -> Self {
        Self(core::array::from_fn(|order| self.0[order] + other.0[order]))
    }

    pub(crate) fn subtract(self, other: Self) -> Self {
        Self(core::array::from_fn(|order| self.0[order] - other.0[order]))
    }

    pub(crate) fn multiply(self, other: Self) -> Self {
        Self(core::array::from_fn(|order| {
            (1..=order).fold(self.0[0] * other.0[order], |sum, i| sum + self.0[i] * other.0[order - i])
        }))
    }

    pub(crate) fn divide(self, other: Self) -> Self {
        let mut quotient = [T::constant(0.0); N];
        for order in 0..N {
            let rest = (0..order).fold(self.0[order], |rest, i| rest - quotient[i] * other.0[order - i]);
            quotient[order] = rest / other.0[0];
        }
        Self(quotient)
    }

    /// f(self) for a smooth f.
    pub(crate) fn apply(self, function: Function) -> Self {
        self.compose(function.series(self.0[0]))
    }

    /// self^n.
    pub(crate) fn power(self, exponent: i32) -> Self {
        let falling = binomials(f64::from(exponent));
        self.compose(core::array::from_fn(|order| {
            let left = exponent.saturating_sub(order as i32);
            // x^2 has no third derivative, rather than 0 times 1/x.
            if falling[order] == 0.0 { T::constant(0.0) } else { T::constant(falling[order]) * self.0[0].power(left) }
        }))
    }

    /// self^r, for self >= 0.
    pub(crate) fn real_power(self, exponent: f64) -> Self {
        let falling = binomials(exponent);
        self.compose(core::array::from_fn(|order| {
            T::constant(falling[order]) * self.0[0].real_power(exponent - order as f64)
        }))
    }

    /// |self|. At a kink of numbers, `side` tells the branch: the one behind (true) or before.
    pub(crate) fn abs(self, side: bool) -> Self {
        let size = match self.sign(side) {
            Some(true) => return self,
            Some(false) => return self.negate(),
            None => self.0[0].abs(),
        };
        self.kinked(self.negate(), size)
    }

    /// The sign of self, as [`Self::abs`].
    pub(crate) fn signum(self, side: bool) -> Self {
        match self.sign(side) {
            Some(sign) => Self::constant(T::constant(if sign { 1.0 } else { -1.0 })),
            None => {
                let either = T::constant(-1.0).either(T::constant(1.0));
                Self(core::array::from_fn(|order| if order == 0 { either } else { T::unknown() }))
            }
        }
    }

    /// The lesser of two, as [`Self::abs`].
    pub(crate) fn min(self, other: Self, side: bool) -> Self {
        match other.subtract(self).sign(side) {
            Some(true) => self,
            Some(false) => other,
            None => self.kinked(other, self.0[0].min(other.0[0])),
        }
    }

    /// The greater of two, as [`Self::abs`].
    pub(crate) fn max(self, other: Self, side: bool) -> Self {
        self.negate().min(other.negate(), side).negate()
    }

    /// One of two branches that meet where they change: slopes of either, and no more is known.
    fn kinked(self, other: Self, value: T) -> Self {
        Self(core::array::from_fn(|order| match order {
            0 => value,
            1 => self.0[1].either(other.0[1]),
            _ => T::unknown(),
        }))
    }

    /// The sign on one side of x: that of the first coefficient that is not 0.
    fn sign(&self, side: bool) -> Option<bool> {
        match self.0.iter().position(|coefficient| !coefficient.is_zero()) {
            None => Some(true),
            Some(order) => self.0[order].sign().map(|sign| if order % 2 == 1 { sign == side } else { sign }),
        }
    }

    /// f(self) from f's own series at self's value.
    fn compose(self, outer: [T; 4]) -> Self {
        Self(core::array::from_fn(|order| {
            let inner = |index: usize| self.0[index];
            match order {
                0 => outer[0],
                1 => outer[1] * inner(1),
                2 => outer[1] * inner(2) + outer[2] * inner(1).square(),
                _ => {
                    let mixed = T::constant(2.0) * outer[2] * inner(1) * inner(2);
                    outer[1] * inner(3) + mixed + outer[3] * inner(1) * inner(1).square()
                }
            }
        }))
    }
}

/// 1, r, r (r - 1)/2, r (r - 1) (r - 2)/6.
fn binomials(exponent: f64) -> [f64; 4] {
    let second = exponent * (exponent - 1.0) / 2.0;
    [1.0, exponent, second, second * (exponent - 2.0) / 3.0]
}
