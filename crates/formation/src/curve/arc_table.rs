//! Arc length of a piece as a polynomial, instead of a quadrature at every question.
use crate::lanes::call_for;
use core::f64::consts::PI;
use wide::f64x2;

/// Points at which the speed is interpolated.
const COUNT: usize = 24;
/// Coefficients of the speed that are below this part of the first are as good as nothing.
const NOTHING: f64 = 2e-16;
/// What the last coefficients may be at most for the polynomial to be as exact as the quadrature.
const SETTLED: f64 = 1e-14;

/// The integral of the Chebyshev interpolant of the speed (L. N. Trefethen, "Approximation Theory and Approximation Practice",
/// 2013), as coefficients of the powers of t, which goes from -1 to 1 over the piece. None where so few points do not do.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct ArcTable {
    /// Coefficients of an even power and the odd one after it.
    pairs: [f64x2; COUNT / 2 + 1],
    count: usize,
}

impl ArcTable {
    /// Of a piece of `length` (m) that is run through at `speed` (m for each unit of t).
    pub(super) fn of(speed: impl Fn(f64) -> f64, length: f64) -> Self {
        // cos(pi m / 48): all cosines that there are.
        let cosines: [f64; 4 * COUNT] = core::array::from_fn(|m| libm::cos(PI * m as f64 / (2 * COUNT) as f64));
        let cosine = |m: usize| cosines[m % (4 * COUNT)];
        let speeds: [f64; COUNT] = core::array::from_fn(|j| speed(cosine(2 * j + 1)));
        let coefficient = |k: usize| {
            let sum: f64 = speeds.iter().enumerate().map(|(j, speed)| speed * cosine(k * (2 * j + 1))).sum();
            sum * if k == 0 { 1.0 } else { 2.0 } / COUNT as f64
        };
        let speed: [f64; COUNT] = core::array::from_fn(coefficient);
        if !speed[COUNT - 3..].iter().all(|last| last.abs() <= SETTLED * speed[0]) {
            return Self::default();
        }
        let degree = speed.iter().rposition(|value| value.abs() > NOTHING * speed[0]).unwrap_or(0);
        let at = |k: usize| if k <= degree { speed[k] } else { 0.0 };
        let integral = |k: usize| {
            let before = if k == 1 { 2.0 * at(0) } else { at(k - 1) };
            (before - at(k + 1)) / (2 * k) as f64
        };
        let mut powers = powers_of((1..=degree + 1).map(integral));
        let at_start: f64 = powers.iter().rev().fold(0.0, |sum, power| power - sum);
        powers[0] -= at_start;
        let mut table = Self { count: powers.len().div_ceil(2), ..Self::default() };
        for (pair, powers) in table.pairs.iter_mut().zip(powers.chunks(2)) {
            *pair = f64x2::new([powers[0], powers.get(1).copied().unwrap_or(0.0)]);
        }
        // What the interpolation leaves of rounding is spread over the piece, so that its end is where the next begins.
        let whole = table.value(1.0);
        Self { pairs: table.pairs.map(|pair| pair * f64x2::splat(length / whole)), ..table }
    }

    /// Lets it come nearer to the processor.
    #[inline]
    pub(super) fn call(&self) {
        self.pairs.iter().step_by(4).take(2).for_each(call_for);
        call_for(&self.count);
    }

    /// Arc length from the start of the piece to t, m.
    #[inline]
    fn value(&self, t: f64) -> f64 {
        let square = f64x2::splat(t * t);
        let sum = self.pairs[..self.count].iter().rev().fold(f64x2::ZERO, |sum, pair| sum * square + *pair);
        let [even, odd] = sum.to_array();
        even + t * odd
    }

    /// Arc length from the start of the piece to t, m.
    #[inline]
    pub(super) fn length_to(&self, t: f64) -> Option<f64> {
        (self.count > 0).then(|| self.value(t))
    }
}

/// Coefficients of powers of the Chebyshev series that begins with T_1.
fn powers_of(series: impl Iterator<Item = f64>) -> Vec<f64> {
    let (mut before, mut polynomial) = (vec![1.0], vec![0.0, 1.0]);
    let mut powers: Vec<f64> = Vec::new();
    for coefficient in series {
        powers.resize(polynomial.len(), 0.0);
        for (power, value) in powers.iter_mut().zip(&polynomial) {
            *power += coefficient * value;
        }
        let mut next = vec![0.0; polynomial.len() + 1];
        for (index, value) in polynomial.iter().enumerate() {
            next[index + 1] = 2.0 * value;
        }
        for (value, earlier) in next.iter_mut().zip(&before) {
            *value -= earlier;
        }
        before = core::mem::replace(&mut polynomial, next);
    }
    powers
}

#[cfg(test)]
mod tests {
    use super::super::primitive::Primitive;
    use super::super::quadrature::arc_length;
    use super::*;
    use nalgebra::Vector2;

    #[track_caller]
    fn check(primitive: &Primitive, (from, to): (f64, f64)) {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let table = ArcTable::of(speed_of(primitive, (middle, half)), arc_length(primitive, from, to));
        for step in 0..=40 {
            let parameter = from + (to - from) * f64::from(step) / 40.0;
            let at = |share: i32| from + (parameter - from) * f64::from(share) / 8.0;
            let fine: f64 = (0..8).map(|share| arc_length(primitive, at(share), at(share + 1))).sum();
            let length = table.length_to((parameter - middle) / half).unwrap();
            assert!((length - fine).abs() < 4e-15 * (1.0 + fine), "{step}: {length} is not {fine}");
        }
    }

    fn speed_of(primitive: &Primitive, (middle, half): (f64, f64)) -> impl Fn(f64) -> f64 {
        move |t| half * primitive.evaluate(middle + half * t).first.norm()
    }

    #[test]
    fn as_exact_as_quadrature() {
        let at = Vector2::new;
        let ellipse = Primitive::Ellipse { centre: at(3.0, 4.0), cosine: at(2.0, 0.0), sine: at(0.0, 1.0) };
        check(&ellipse, (0.2, 0.5));
        let cubic = Primitive::bezier([at(-1.0, 0.0), at(-0.5, 2.0), at(0.5, -2.0), at(1.0, 0.3)]);
        check(&cubic, (0.25, 0.28));
        let (along, across) = (at(1.0, 0.0), at(0.0, 4.0));
        let sinusoid = Primitive::Sinusoid { origin: at(0.0, 0.0), along, across, wave_number: 0.15, phase: 1.0 };
        check(&sinusoid, (100.0, 102.0));
    }

    /// A part that is too long for so few points.
    #[test]
    fn no_table_where_it_would_not_be_exact() {
        let at = Vector2::new;
        let ellipse = Primitive::Ellipse { centre: at(0.0, 0.0), cosine: at(5.0, 0.0), sine: at(0.0, 0.1) };
        assert_eq!(ArcTable::of(speed_of(&ellipse, (1.5, 1.5)), 9.0).length_to(1.0), None);
    }
}
