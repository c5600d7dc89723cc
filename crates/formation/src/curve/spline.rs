//! Natural cubic splines through knots (de Boor, *A Practical Guide to Splines*, chapter IV).
use super::primitive::Primitive;
use nalgebra::Vector2;

/// One cubic a knot interval, each over 0 <= u <= 1. Knots are two or more, neighbours apart; the spline's parameter
/// is chord length, so that unevenly spaced knots do not make it overshoot.
pub(super) fn natural_cubic(knots: &[Vector2<f64>]) -> Vec<Primitive> {
    let widths: Vec<f64> = knots.windows(2).map(|pair| (pair[1] - pair[0]).norm()).collect();
    let second = second_derivatives(knots, &widths);
    let piece = |i: usize| {
        let (h, start, end) = (widths[i], knots[i], knots[i + 1]);
        let (a, b) = (h * h * second[i], h * h * second[i + 1]);
        let coefficients = [start, end - start - (2.0 * a + b) / 6.0, 0.5 * a, (b - a) / 6.0];
        Primitive::Cubic { coefficients }
    };
    (0..widths.len()).map(piece).collect()
}

/// Second derivatives by chord length at the knots: zero at both ends, a tridiagonal system between (Thomas).
fn second_derivatives(knots: &[Vector2<f64>], widths: &[f64]) -> Vec<Vector2<f64>> {
    let count = knots.len();
    let mut second = vec![Vector2::zeros(); count];
    let mut ratio = vec![0.0; count];
    for i in 1..count - 1 {
        let (left, right) = (widths[i - 1], widths[i]);
        let slope_change = (knots[i + 1] - knots[i]) / right - (knots[i] - knots[i - 1]) / left;
        let pivot = 2.0 * (left + right) - left * ratio[i - 1];
        ratio[i] = right / pivot;
        second[i] = (6.0 * slope_change - left * second[i - 1]) / pivot;
    }
    for i in (1..count - 1).rev() {
        second[i] = second[i] - ratio[i] * second[i + 1];
    }
    second
}
