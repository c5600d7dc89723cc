//! One wall of the zoning potential: strength/(2 delta^m) over the depth delta in front of a pole, bounded.
use super::{Edge, Sharpness};

/// A potential wall as a function of the distance delta to its pole: nothing from `width` on, rising towards the pole, and
/// continued with its steepest permitted slope through the pole and beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Barrier {
    /// alpha or beta.
    strength: f64,
    /// m.
    exponent: i32,
    /// delta at the edge of the zone, metres.
    width: f64,
    /// Whether the slope is lowered by its value at the edge, and so begins at 0.
    continuous: bool,
    /// The largest slope, m/s^2.
    cap: f64,
}

impl Barrier {
    pub(super) fn new(strength: f64, sharpness: Sharpness, width: f64, edge: Edge, cap: f64) -> Self {
        let exponent = match sharpness {
            Sharpness::One => 1,
            Sharpness::Two => 2,
        };
        Self { strength, exponent, width, continuous: edge == Edge::Continuous, cap }
    }

    /// The largest slope, m/s^2.
    pub(super) fn cap(&self) -> f64 {
        self.cap
    }

    /// -dPsi/d(delta) >= 0, m/s^2.
    #[inline(always)]
    pub(super) fn slope(&self, delta: f64) -> f64 {
        if delta >= self.width {
            0.0
        } else if delta <= 0.0 {
            self.cap
        } else {
            (self.steepness(delta) - self.offset()).min(self.cap)
        }
    }

    /// Psi, with 0 at the edge.
    #[inline(always)]
    pub(super) fn value(&self, delta: f64) -> f64 {
        if delta >= self.width {
            return 0.0;
        }
        let knee = self.knee();
        if delta < knee { self.uncapped_value(knee) + self.cap * (knee - delta) } else { self.uncapped_value(delta) }
    }

    fn uncapped_value(&self, delta: f64) -> f64 {
        let height = |delta: f64| 0.5 * self.strength / power(delta, self.exponent);
        height(delta) - height(self.width) - self.offset() * (self.width - delta)
    }

    #[inline]
    fn steepness(&self, delta: f64) -> f64 {
        0.5 * f64::from(self.exponent) * self.strength / power(delta, self.exponent + 1)
    }

    #[inline]
    fn offset(&self) -> f64 {
        if self.continuous { self.steepness(self.width) } else { 0.0 }
    }

    /// Where the slope reaches its cap.
    fn knee(&self) -> f64 {
        let ratio = 0.5 * f64::from(self.exponent) * self.strength / (self.cap + self.offset());
        let knee = if self.exponent == 1 { ratio.sqrt() } else { libm::cbrt(ratio) };
        knee.min(self.width)
    }
}

/// delta to the power 1, 2 or 3.
fn power(delta: f64, exponent: i32) -> f64 {
    (1..exponent).fold(delta, |product, _| product * delta)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The slope belongs to the value, never grows with delta, and the value is continuous at knee and edge.
        #[test]
        fn value_and_slope(delta in -1.0..4.0_f64, exponent in 1..3_i32, continuous: bool, cap in 2.0..50.0_f64) {
            let barrier = Barrier { strength: 10.0, exponent, width: 3.0, continuous, cap };
            let step = 1e-6;
            let difference = (barrier.value(delta - step) - barrier.value(delta + step)) / (2.0 * step);
            prop_assume!((delta - 3.0).abs() > 2.0 * step && (delta - barrier.knee()).abs() > 2.0 * step);
            prop_assert!((difference - barrier.slope(delta)).abs() < 1e-5 * (1.0 + difference), "{difference}");
            prop_assert!(barrier.slope(delta) >= barrier.slope(delta + 0.1) && barrier.slope(delta) <= cap);
            prop_assert!(!continuous || barrier.slope(3.0 - 1e-9) < 1e-7);
        }
    }
}
