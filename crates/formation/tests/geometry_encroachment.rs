//! Encroachment of the diagonal of 7.10 by its four discs.
use core::f64::consts::SQRT_2;
use nalgebra::{Isometry2, Vector2};
use proptest::prelude::*;
use trench_formation::curve::{Curve, CurveShape, Placed, encroached, qualified_fragments};
use trench_formation::hull::Outline;

fn at(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

fn points_as_outlines(points: &[Vector2<f64>]) -> Vec<Outline<'_>> {
    points.chunks(1).map(|points| Outline { points, radius: 0.0 }).collect()
}

#[test]
fn the_discs_of_7_10() {
    let diagonal = Curve::new(&CurveShape::Line(at(-5.0, -5.0), at(100.0, 100.0)), false, false).unwrap();
    let segment = Placed::new(&diagonal, Isometry2::identity());
    let discs = [at(30.0, 25.0), at(40.0, 43.0), at(84.0, 86.0), at(92.0, 90.0)];
    let whole = (0.0, diagonal.length());
    let found = encroached(&segment, whole, &points_as_outlines(&discs), 3.0);
    let half = 7.0_f64.sqrt();
    let expected = [
        (45.0 * SQRT_2, 48.0 * SQRT_2),
        (90.0 * SQRT_2 - half, 90.0 * SQRT_2 + half),
        (96.0 * SQRT_2 - half, 96.0 * SQRT_2 + half),
    ];
    assert_eq!(found.len(), 3, "{found:?}");
    for (interval, expected) in found.iter().zip(expected) {
        assert!((interval.0 - expected.0).abs() < 1e-9 && (interval.1 - expected.1).abs() < 1e-9, "{interval:?}");
    }
    assert_eq!(qualified_fragments(&diagonal, whole, &found, 0.0).len(), 4);
    let roomy = qualified_fragments(&diagonal, whole, &found, 4.0);
    assert_eq!(roomy, [(0.0, found[0].0), (found[0].1, found[1].0), (found[2].1, whole.1)]);
    assert_eq!(qualified_fragments(&diagonal, whole, &[whole], 0.0), [], "the whole segment is covered");
    assert_eq!(qualified_fragments(&diagonal, whole, &[], 1.0), [whole]);
}

proptest! {
    #[test]
    fn sampling_agrees(x in -1.5..1.5_f64, y in -1.5..1.5_f64, reach in 0.05..0.8_f64, other in -1.5..1.5_f64) {
        let wave = CurveShape::Sinusoid {
            origin: at(-1.5, 0.0), direction: 0.0, length: 3.0, amplitude: 0.6, wavelength: 1.0, phase: 0.3,
        };
        let curve = Curve::new(&wave, false, false).unwrap();
        let segment = Placed::new(&curve, Isometry2::new(at(0.1, 0.2), 0.3));
        let obstacles = [at(x, y), at(y, other)];
        let found = encroached(&segment, (0.0, curve.length()), &points_as_outlines(&obstacles), reach);
        for i in 0..=500 {
            let s = curve.length() * f64::from(i) / 500.0;
            let point = segment.at(s).point;
            let near = obstacles.iter().map(|obstacle| (obstacle - point).norm()).fold(f64::INFINITY, f64::min);
            let inside = found.iter().any(|(from, to)| *from <= s && s <= *to);
            prop_assert!((near - reach).abs() < 1e-6 || inside == (near < reach), "{s} {near}");
        }
    }
}
