//! Curves as chains of straight pieces, for those who draw them.

use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveShape};

/// Straight pieces that stand for a bent curve.
const PIECES: usize = 96;

/// Points along a curve, m, in its frame, dense enough to draw. Ends that are open go on by `extension` (m).
#[must_use]
pub fn sampled(shape: &CurveShape, curve: &Curve, extension: f64) -> Vec<Vector2<f64>> {
    let mut points = match shape {
        CurveShape::Line(from, to) => vec![*from, *to],
        CurveShape::Polyline(corners) => corners.clone(),
        _ => (0..=PIECES).map(|step| at(curve, curve.length() * step as f64 / PIECES as f64)).collect(),
    };
    let (from, to) = curve.domain();
    if from.is_infinite() {
        points.insert(0, at(curve, -extension));
    }
    if to.is_infinite() {
        points.push(at(curve, curve.length() + extension));
    }
    points
}

fn at(curve: &Curve, arc_length: f64) -> Vector2<f64> {
    // A closed curve begins again where it ends.
    let wraps = curve.is_closed() && arc_length >= curve.length();
    curve.at(if wraps { 0.0 } else { arc_length }).point
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(shape: CurveShape, open: bool, count: usize, first: [f64; 2], last: [f64; 2]) {
        let points = sampled(&shape, &Curve::new(&shape, open, open).unwrap(), 0.5);
        assert_eq!(points.len(), count);
        for (point, expected) in [(points[0], first), (points[count - 1], last)] {
            assert!((point - Vector2::from(expected)).norm() < 1e-9, "{point} is not {expected:?}");
        }
    }

    #[test]
    fn corners_are_kept_bends_are_sampled_open_ends_go_on() {
        let point = Vector2::new;
        check(CurveShape::Line(point(0.0, 0.0), point(2.0, 0.0)), false, 2, [0.0, 0.0], [2.0, 0.0]);
        check(CurveShape::Line(point(0.0, 0.0), point(2.0, 0.0)), true, 4, [-0.5, 0.0], [2.5, 0.0]);
        let corner = vec![point(0.0, 0.0), point(1.0, 0.0), point(1.0, 1.0)];
        check(CurveShape::Polyline(corner), true, 5, [-0.5, 0.0], [1.0, 1.5]);
        let circle = CurveShape::Ellipse { centre: point(1.0, 0.0), semi_axes: [0.5, 0.5], rotation: 0.0 };
        check(circle, false, PIECES + 1, [1.5, 0.0], [1.5, 0.0]);
    }
}
