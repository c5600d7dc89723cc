use super::super::level::Level;
use super::super::primitive::Primitive;
use super::super::{Curve, CurveShape};
use super::*;
use core::f64::consts::{PI, TAU};
use nalgebra::Isometry2;
use proptest::prelude::*;
use trench_expression::Expression;

/// More evaluations than these are no search, but a hang in the making.
const MOST: u32 = 2_000;
/// For curves that are neither straight nor circles and follow one within a micrometre or less, perhaps crossing it with each wave.
const MOST_NEARLY: u32 = 6_000;

fn at(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

fn rectangle(low: Vector2<f64>, high: Vector2<f64>) -> [Vector2<f64>; 4] {
    [low, at(high.x, low.y), high, at(low.x, high.y)]
}

fn curve(shape: &CurveShape, open: bool) -> Curve {
    Curve::new(shape, open, open).unwrap()
}

/// What an outline takes of a curve, held to a scan: told where it reaches in by more than a micrometre, not told where it does not.
#[track_caller]
fn taken(curve: &Curve, frame: Isometry2<f64>, points: &[Vector2<f64>], radius: f64, reach: f64) -> Vec<Interval> {
    let (segment, evaluations) = (Placed::new(curve, frame), Cell::new(0));
    let points: Vec<Vector2<f64>> = points.iter().map(|point| segment.point_to_map(*point)).collect();
    let outline = Outline { points: &points, radius };
    let found = taken_by(&segment, curve.domain(), &outline, reach, &evaluations);
    let is_exact = |primitive: &Primitive| matches!(primitive, Primitive::Line { .. }) || primitive.circle().is_some();
    let most = if curve.primitives.iter().all(is_exact) { MOST } else { MOST_NEARLY };
    assert!(evaluations.get() < most, "{} evaluations", evaluations.get());
    let beyond = if curve.domain().0.is_finite() { 0.0 } else { 10.0 };
    for index in 0..=20_000 {
        let arc_length = -beyond + (curve.length() + 2.0 * beyond) * f64::from(index) / 20_000.0;
        let excess = outline.approach(segment.at(arc_length).point).gap - reach;
        let is_inside = found.iter().any(|(from, to)| *from <= arc_length && arc_length <= *to);
        assert!(is_inside == (excess < 0.0) || excess.abs() < 2.0 * SHALLOW, "{arc_length}: {excess} {found:?}");
    }
    found
}

fn frames() -> impl Iterator<Item = Isometry2<f64>> {
    (0..12).map(|turn| Isometry2::new(at(0.3 * f64::from(turn), -1.7), 0.37 * f64::from(turn)))
}

/// Faces at the reach and a little off it, whatever the frame rounds.
#[test]
fn a_straight_face_along_the_segment() {
    let line = curve(&CurveShape::Line(at(-9.0, 0.0), at(9.0, 0.0)), false);
    for frame in frames() {
        for (face, is_near) in [
            (1.0, false),
            (1.0 - 1e-9, false),
            (1.0 + 1e-9, false),
            (1.0 + 1e-6, false),
            (1.0 - 1e-6, true),
            (1.0 - 1e-5, true),
            (0.9, true),
            (1.0001, false),
        ] {
            for radius in [0.0, 0.25] {
                let corners = rectangle(at(-3.0, face + radius), at(3.0, face + radius + 2.0));
                let found = taken(&line, frame, &corners, radius, 1.0);
                assert_eq!(found.len(), usize::from(is_near), "{face}: {found:?}");
                for (from, to) in found {
                    let beyond = ((1.0 - face) * (1.0 + face + 2.0 * radius)).sqrt();
                    let tolerance = 1e-9 / beyond;
                    assert!(
                        (from - 6.0 + beyond).abs() < tolerance && (to - 12.0 - beyond).abs() < tolerance,
                        "{face}"
                    );
                }
            }
        }
    }
}

#[test]
fn an_arc_along_a_disc() {
    let arc = CurveShape::Arc { centre: at(0.0, 0.0), radius: 3.0, start_angle: 0.3, sweep: 4.0 };
    let graph = |text: &str| CurveShape::Graph { function: Expression::parse(text).unwrap(), from: -2.5, to: 2.5 };
    let off = [0.0, 1e-9, -1e-9, 1e-6, -1e-6, 1e-4, -1e-4, 2e-3];
    for shape in [arc, graph("sqrt(9 - x^2)"), graph("sqrt(9 - x^2) + 2e-6*sin(4*x)")] {
        let curve = curve(&shape, false);
        for (off, frame) in off.into_iter().zip(frames()) {
            let found = taken(&curve, frame, &[at(0.0, 0.0)], 2.0, 1.0 + off);
            let is_wavy = matches!(&shape, CurveShape::Graph { function, .. } if function.source().contains("sin"));
            if !is_wavy {
                let whole = [(0.0, curve.length())];
                assert_eq!(found, if off > 5e-7 { &whole[..] } else { &[] }, "{off}");
            }
            // Beside the middle, and as the corner of a larger one.
            taken(&curve, frame, &[at(1e-5, 2e-6)], 2.0, 1.0 + off);
            taken(&curve, frame, &[at(0.0, 0.0), at(0.0, -2.0)], 2.0, 1.0 + off);
        }
    }
}

#[test]
fn a_large_ring_is_bounded_too() {
    let ring = CurveShape::Arc { centre: at(0.0, 0.0), radius: 60.0, start_angle: 0.3, sweep: TAU };
    let ring = curve(&ring, false);
    for (off, count) in [(-1e-9, 0), (0.0, 0), (1e-6, 1)] {
        assert_eq!(taken(&ring, Isometry2::identity(), &[at(0.0, 0.0)], 50.0, 10.0 + off).len(), count);
    }
    // Deep on one side of where the ring begins, shallow on the other: one encroachment.
    let (sine, cosine) = libm::sincos(0.3 + 1e-3 / 60.0);
    let found = taken(&ring, Isometry2::identity(), &[60.0 * at(cosine, sine)], 0.0, 1.000_2e-3);
    assert_eq!(found.len(), 2, "{found:?}");
}

#[test]
fn an_open_polyline_about_a_rectangle() {
    let corners = vec![at(-9.0, 0.0), at(9.0, 0.0), at(9.0, 5.0), at(-9.0, 5.0)];
    let obstacle = rectangle(at(-3.0, 2.0), at(3.0, 4.0));
    for open in [true, false] {
        let curve = curve(&CurveShape::Polyline(corners.clone()), open);
        for frame in frames() {
            assert_eq!(taken(&curve, frame, &obstacle, 0.0, 1.0), []);
            assert_eq!(taken(&curve, frame, &obstacle, 0.0, 1.0 + 1e-6).len(), 1);
            assert_eq!(taken(&curve, frame, &obstacle, 0.0, 2.0 + 1e-6).len(), 2);
            // Along the extension, at the reach of it.
            let beyond = rectangle(at(-16.0, 6.0), at(-12.0, 8.0));
            assert_eq!(taken(&curve, frame, &beyond, 0.0, 1.0), []);
            assert_eq!(taken(&curve, frame, &beyond, 0.0, 1.0 + 1e-6).len(), usize::from(open));
        }
    }
}

/// Curves of all kinds that run about a rounded rectangle at the reach, as nearly as they can.
#[test]
fn curves_that_only_nearly_run_along() {
    let knots: Vec<Vector2<f64>> =
        (0..=40).map(|i| PI * f64::from(i) / 40.0).map(|u| 3.0 * at(libm::cos(u), libm::sin(u))).collect();
    let wave = |amplitude: f64| CurveShape::Sinusoid {
        origin: at(-4.0, 0.0),
        direction: 0.0,
        length: 8.0,
        amplitude,
        wavelength: 2.0,
        phase: 0.4,
    };
    for off in [0.0, 3e-7, -1e-6, 1e-6, 1e-5] {
        for shape in [
            CurveShape::Spline(knots.clone()),
            CurveShape::Ellipse { centre: at(0.0, 0.0), semi_axes: [3.0, 3.0 + 1e-9], rotation: 0.2 },
            CurveShape::Ellipse { centre: at(0.0, 0.0), semi_axes: [3.0, 3.0 + 1e-5], rotation: 0.2 },
        ] {
            taken(&curve(&shape, false), Isometry2::identity(), &[at(0.0, 0.0)], 2.0, 1.0 + off);
        }
        for amplitude in [1e-9, 1e-7, 1e-6, 1e-5, 1e-2] {
            let corners = rectangle(at(-2.0, 1.0 + amplitude), at(2.0, 3.0));
            taken(&curve(&wave(amplitude), false), Isometry2::identity(), &corners, 0.1, 0.9 + off);
        }
    }
}

/// A wall that moves along itself at the reach on the test bed, looked at anew each tick of 50 ms in the frame of a target that drives.
#[test]
fn every_tick_beside_a_moving_wall_is_bounded() {
    let line = curve(&CurveShape::Line(at(0.3, 0.5), at(2.3, 0.5)), false);
    for tick in 0..200 {
        let moved = 5e-5 * f64::from(tick);
        let corners = rectangle(at(1.0 + moved, 0.76), at(1.3 + moved, 1.0));
        let (turned, evaluations) =
            (Isometry2::new(at(0.013 * f64::from(tick), 0.2), 0.01 * f64::from(tick)), Cell::new(0));
        let segment = Placed::new(&line, turned);
        let points = corners.map(|corner| segment.point_to_map(corner));
        let found = taken_by(&segment, line.domain(), &Outline { points: &points, radius: 0.0 }, 0.26, &evaluations);
        assert_eq!(found, [], "tick {tick}");
        assert!(evaluations.get() < 200, "{} evaluations", evaluations.get());
    }
}

/// A function of which no more than its slope is known.
struct Blind<L>(L);

impl<L: Level> Level for Blind<L> {
    fn at(&self, parameter: f64) -> (f64, f64) {
        self.0.at(parameter)
    }

    fn bounds(&self, _: f64, _: f64, _: [f64; 2]) -> (f64, f64) {
        (f64::NEG_INFINITY, f64::INFINITY)
    }
}

/// By slopes alone, as they did before curvatures were looked at.
fn by_slopes(curve: &Curve, outline: &Outline<'_>, reach: f64) -> Vec<Interval> {
    let (segment, evaluations) = (Placed::new(curve, Isometry2::identity()), Cell::new(0));
    let straight = Excess {
        segment: &segment,
        outline,
        reach,
        slack: 0.0,
        second: 0.0,
        third: 0.0,
        circle: None,
        evaluations: &evaluations,
    };
    let mut found = Vec::new();
    for (index, piece) in curve.pieces.iter().enumerate() {
        let primitive = &curve.primitives[piece.primitive];
        let half = 0.5 * (piece.to - piece.from);
        let (second, _) = primitive.derivative_bounds(0.5 * (piece.from + piece.to), half);
        let excess = Excess { slack: half * second, ..straight };
        below((piece.from, piece.to), &Blind(excess.along(|u| primitive.evaluate(u))), |run| {
            found.push((curve.arc_length_at(index, run.from), curve.arc_length_at(index, run.to)));
        });
    }
    united(found)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Curvatures save work and change not a bit.
    #[test]
    fn as_slopes_alone_tell(
        kind in 0..5_u32, points in prop::collection::vec((-2.0..2.0_f64, -2.0..2.0_f64), 1..6), radius in 0.0..0.4_f64,
        reach in 0.05..0.8_f64,
    ) {
        let shape = match kind {
            0 => CurveShape::Line(at(-2.0, -1.0), at(2.0, 1.3)),
            1 => CurveShape::Arc { centre: at(0.1, 0.2), radius: 1.1, start_angle: 0.3, sweep: 4.0 },
            2 => CurveShape::Spline(vec![at(-2.0, 0.0), at(-0.5, 1.0), at(0.7, -1.0), at(2.0, 0.4)]),
            3 => CurveShape::Sinusoid { origin: at(-2.0, 0.0), direction: 0.1, length: 4.0, amplitude: 0.6, wavelength: 1.0, phase: 0.3 },
            _ => CurveShape::Graph { function: Expression::parse("x^3/4 - exp(-x^2)").unwrap(), from: -1.7, to: 1.7 },
        };
        let curve = curve(&shape, false);
        let points: Vec<Vector2<f64>> = points.into_iter().map(|(x, y)| at(x, y)).collect();
        let shape = crate::hull::Shape::enclosing(&points, radius).unwrap();
        let (segment, evaluations) = (Placed::new(&curve, Isometry2::identity()), Cell::new(0));
        let found = taken_by(&segment, curve.domain(), &shape.outline(), reach, &evaluations);
        prop_assert_eq!(found, by_slopes(&curve, &shape.outline(), reach));
        prop_assert!(evaluations.get() < MOST, "{} evaluations", evaluations.get());
    }
}
