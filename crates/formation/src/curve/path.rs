//! Where a short piece lies, as a polynomial: far less work than its primitive's own functions, and as exact.
use super::primitive::{Jet, Primitive};
use core::ops::{Add, Mul};
use nalgebra::Vector2;
use wide::f64x2;

/// Most coefficients.
const MOST: usize = 16;
/// What the first term that is left out may be at most, as a part of the first power's; and terms that are as good as nothing.
const EXACT: f64 = 1e-16;
const NOTHING: f64 = 1e-16;

/// The Taylor polynomial of a primitive about the middle of a piece by t, which goes from -1 to 1 over the piece.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Path {
    /// Both coordinates at once.
    coefficients: [f64x2; MOST],
    count: usize,
}

impl Path {
    /// Nothing where so few terms would not be exact.
    pub(super) fn of(primitive: &Primitive, from: f64, to: f64) -> Option<Self> {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let mut coefficients = [Vector2::zeros(); MOST];
        let rest = match primitive {
            // Of expressions three derivatives are known.
            Primitive::Line { .. } | Primitive::Graph { .. } => return None,
            Primitive::Cubic { coefficients: [c0, c1, c2, c3] } => {
                coefficients[0] = c0 + middle * (c1 + middle * (c2 + middle * c3));
                coefficients[1] = half * (c1 + middle * (2.0 * c2 + 3.0 * middle * c3));
                coefficients[2] = half * half * (c2 + 3.0 * middle * c3);
                coefficients[3] = half * half * half * c3;
                0.0
            }
            Primitive::Ellipse { centre, cosine, sine } => {
                let (s, c) = libm::sincos(middle);
                let arm = c * cosine + s * sine;
                let rest = waves(arm, c * sine - s * cosine, half, &mut coefficients);
                coefficients[0] += centre;
                rest
            }
            Primitive::Sinusoid { origin, along, across, wave_number, phase } => {
                let (s, c) = libm::sincos(wave_number * middle + phase);
                let rest = waves(s * across, c * across, wave_number * half, &mut coefficients);
                coefficients[0] += origin + middle * along;
                coefficients[1] += half * along;
                rest
            }
        };
        let scale = coefficients[1].norm();
        let is_something = |term: &Vector2<f64>| term.norm() > NOTHING * scale;
        let count = coefficients.iter().rposition(is_something)? + 1;
        coefficients[count..].fill(Vector2::zeros());
        let coefficients = coefficients.map(|term| f64x2::new(term.into()));
        (rest <= EXACT * scale).then_some(Self { coefficients, count })
    }

    /// All coefficients, those of both coordinates in each: zero beyond those that are something.
    #[inline]
    pub(super) fn coefficients(&self) -> &[f64x2; MOST] {
        &self.coefficients
    }

    /// How many of them are something.
    #[inline]
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Position and three derivatives, all by t.
    #[inline]
    pub(super) fn at(&self, t: f64) -> (Jet, Vector2<f64>) {
        let terms = self.coefficients[..self.count].iter().rev().copied();
        let [point, first, second, third] = horner(terms, f64x2::splat(t), f64x2::ZERO);
        let vector = |lanes: f64x2| Vector2::from(lanes.to_array());
        (Jet { point: vector(point), first: vector(first), second: 2.0 * vector(second) }, 6.0 * vector(third))
    }
}

/// A polynomial whose terms come from the highest power down, and its derivatives: the second halved, the third a sixth.
#[inline(always)]
pub(super) fn horner<V, T>(terms: impl Iterator<Item = V>, t: T, zero: V) -> [V; 4]
where
    V: Copy + Add<Output = V>,
    T: Copy + Mul<V, Output = V>,
{
    terms.fold([zero; 4], |[point, first, second, third], term| {
        [t * point + term, t * first + point, t * second + first, t * third + second]
    })
}

/// Terms of A cos x + B sin x about x = 0, x = `half` t; a bound of the first that is left out.
fn waves(value: Vector2<f64>, slope: Vector2<f64>, half: f64, terms: &mut [Vector2<f64>]) -> f64 {
    let mut factor = 1.0;
    for (index, term) in terms.iter_mut().enumerate() {
        let sign = if index & 2 == 0 { factor } else { -factor };
        *term = sign * if index & 1 == 0 { value } else { slope };
        factor *= half / (index + 1) as f64;
    }
    factor * value.norm().max(slope.norm())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(primitive: &Primitive, (from, to): (f64, f64)) {
        let path = Path::of(primitive, from, to).unwrap();
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        for step in -20..=20 {
            let t = f64::from(step) / 20.0;
            let expected = primitive.evaluate(middle + half * t);
            let (jet, _) = path.at(t);
            let scale = 1e-14 * (1.0 + expected.point.norm());
            assert!((jet.point - expected.point).norm() < scale, "{t}: {jet:?} is not {expected:?}");
            assert!((jet.first / half - expected.first).norm() < scale, "{t}: {jet:?} is not {expected:?}");
            assert!((jet.second / (half * half) - expected.second).norm() < 10.0 * scale, "{t}: {jet:?}");
            let near = |by: f64| path.at(t + by).0.second;
            let third = (near(1e-4) - near(-1e-4)) / 2e-4;
            assert!((path.at(t).1 - third).norm() < 1e-6 * half, "{t}: {third}");
        }
    }

    #[test]
    fn as_exact_as_the_primitive() {
        let at = Vector2::new;
        check(&Primitive::Ellipse { centre: at(3.0, 4.0), cosine: at(2.0, 0.0), sine: at(0.0, 1.0) }, (0.2, 0.5));
        check(&Primitive::bezier([at(-1.0, 0.0), at(-0.5, 2.0), at(0.5, -2.0), at(1.0, 0.3)]), (0.25, 0.5));
        let (along, across) = (at(1.0, 0.0), at(0.0, 4.0));
        check(&Primitive::Sinusoid { origin: at(0.0, 0.0), along, across, wave_number: 0.15, phase: 1.0 }, (9.0, 12.0));
    }

    #[test]
    fn nothing_where_it_would_not_be_exact() {
        let (along, across) = (Vector2::x(), Vector2::y());
        let wave = Primitive::Sinusoid { origin: Vector2::zeros(), along, across, wave_number: 3.0, phase: 0.0 };
        assert_eq!(Path::of(&wave, 0.0, 2.0), None);
    }
}
