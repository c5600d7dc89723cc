//! Curves against closed forms and against dense sampling.
#![expect(clippy::unwrap_used, reason = "a failed construction is a failed test")]
use core::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};
use nalgebra::{Isometry2, Vector2};
use proptest::prelude::*;
use trench_formation::curve::{Curve, CurveError, CurveShape, Placed, Warm};

fn at(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

fn curve(shape: CurveShape) -> Curve {
    Curve::new(&shape, false, false).unwrap()
}

/// y = x^2 for |x| <= 3, exactly.
fn parabola() -> Curve {
    let quadratic = [at(-3.0, 9.0), at(0.0, -9.0), at(3.0, 9.0)];
    let third = |a: Vector2<f64>, b: Vector2<f64>| (a + 2.0 * b) / 3.0;
    let control =
        vec![quadratic[0], third(quadratic[0], quadratic[1]), third(quadratic[2], quadratic[1]), quadratic[2]];
    curve(CurveShape::Bezier(control))
}

fn sine() -> Curve {
    let (origin, direction, phase) = (at(-TAU, 0.0), 0.0, -TAU);
    curve(CurveShape::Sinusoid { origin, direction, length: 2.0 * TAU, amplitude: 1.0, wavelength: TAU, phase })
}

fn shapes() -> Vec<CurveShape> {
    vec![
        CurveShape::Line(at(-1.0, 0.5), at(2.0, -0.3)),
        CurveShape::Polyline(vec![at(0.0, 0.0), at(1.0, 0.2), at(1.2, 1.4), at(-0.5, 1.0)]),
        CurveShape::Polyline(vec![at(0.0, 0.0), at(1.0, 0.0), at(0.5, 1.0), at(0.0, 0.0)]),
        CurveShape::Arc { centre: at(0.2, 0.1), radius: 0.8, start_angle: 2.0, sweep: -4.0 },
        CurveShape::Arc { centre: at(0.2, 0.1), radius: 0.8, start_angle: 2.0, sweep: TAU },
        CurveShape::Ellipse { centre: at(0.1, 0.2), semi_axes: [1.5, 0.4], rotation: 0.6 },
        CurveShape::Spline(vec![at(-1.0, 0.0), at(-0.2, 0.9), at(0.5, -0.6), at(1.5, 0.4)]),
        CurveShape::Bezier(vec![at(-1.0, 0.0), at(-0.5, 2.0), at(0.5, -2.0), at(1.0, 0.3)]),
        CurveShape::Sinusoid {
            origin: at(-1.0, -1.0),
            direction: 0.4,
            length: 3.0,
            amplitude: 0.4,
            wavelength: 0.9,
            phase: 1.0,
        },
    ]
}

/// Nothing is near what is no point, and nobody dies of the question.
#[test]
fn points_that_are_not_finite_have_no_distance() {
    let line = curve(CurveShape::Polyline(vec![at(0.0, 0.0), at(1.0, 0.0)]));
    for curve in [line, parabola()] {
        for point in [at(f64::NAN, 0.0), at(0.0, f64::NAN), at(f64::INFINITY, 0.0), at(f64::NEG_INFINITY, f64::NAN)] {
            assert!(!curve.nearest(point).distance.is_finite());
            assert!(curve.nearest_all(point).feet.iter().all(|foot| !foot.distance.is_finite()));
            let placed = Placed::new(&curve, Isometry2::identity());
            assert!(!placed.nearest(point).distance.is_finite());
        }
    }
}

#[test]
fn nearest_points_of_the_parabola() {
    for height in [0.75, 1.0, 2.5] {
        let set = parabola().nearest_all(at(0.0, height));
        let x = (height - 0.5_f64).sqrt();
        assert_eq!(set.feet.len(), 2, "{set:?}");
        for (foot, expected) in set.feet.iter().zip([at(-x, x * x), at(x, x * x)]) {
            assert!((foot.point - expected).norm() < 1e-9, "{foot:?}");
            assert!((foot.distance - (height - 0.25).sqrt()).abs() < 1e-9);
        }
    }
}

#[test]
fn the_centre_of_curvature_has_one_nearest_point() {
    let set = parabola().nearest_all(at(0.0, 0.5));
    assert_eq!(set.feet.len(), 1, "{set:?}");
    assert!((set.feet[0].distance - 0.5).abs() < 1e-12);
    assert!(set.feet[0].point.norm() < 1e-3);
}

#[test]
fn nearest_points_of_the_sine() {
    let set = sine().nearest_all(at(FRAC_PI_2, -FRAC_PI_2));
    assert_eq!(set.feet.len(), 2, "{set:?}");
    assert!((set.feet[0].point - at(0.0, 0.0)).norm() < 1e-9);
    assert!((set.feet[1].point - at(PI, 0.0)).norm() < 1e-9);
    assert!((set.feet[0].distance - PI / SQRT_2).abs() < 1e-9);
}

#[test]
fn the_centre_of_a_circle_has_a_range_of_nearest_points() {
    let circle = curve(shapes()[4].clone());
    let set = circle.nearest_all(at(0.2, 0.1));
    assert!(set.feet.is_empty());
    assert_eq!(set.ranges.len(), 1);
    assert!((set.ranges[0].1 - set.ranges[0].0 - TAU * 0.8).abs() < 1e-12);
}

#[test]
fn a_square_seen_from_its_middle_has_four_nearest_points() {
    let corners = vec![at(0.0, 0.0), at(2.0, 0.0), at(2.0, 2.0), at(0.0, 2.0), at(0.0, 0.0)];
    let square = curve(CurveShape::Polyline(corners));
    assert!(square.is_closed());
    let feet = square.nearest_all(at(1.0, 1.0)).feet;
    assert_eq!(feet.iter().map(|foot| foot.arc_length).collect::<Vec<_>>(), [1.0, 3.0, 5.0, 7.0]);
    let outside = square.nearest_all(at(-1.0, -1.0)).feet;
    assert_eq!(outside.len(), 1, "the corner where the curve closes counts once: {outside:?}");
}

#[test]
fn lengths_equal_closed_forms() {
    let length = |index: usize| curve(shapes()[index].clone()).length();
    assert!((length(3) - 3.2).abs() < 1e-14);
    // 4 a E(m): the complete elliptic integral for m = 1 - (0.4 / 1.5)^2, by its arithmetic-geometric mean.
    let (mut a, mut g, mut sum, mut power) = (1.0_f64, 0.4 / 1.5_f64, 1.0 - (0.4 / 1.5_f64).powi(2), 0.5_f64);
    sum *= power;
    for _ in 0..8 {
        let difference = (a - g) / 2.0;
        (a, g) = ((a + g) / 2.0, (a * g).sqrt());
        power *= 2.0;
        sum += power * difference * difference;
    }
    let perimeter = 4.0 * 1.5 * (1.0 - sum) * PI / (2.0 * a);
    assert!((length(5) - perimeter).abs() < 1e-11, "{} {perimeter}", length(5));
    // y = x^2 on [-3, 3].
    let expected = 3.0 * 37.0_f64.sqrt() + 0.5 * 6.0_f64.asinh();
    assert!((parabola().length() - expected).abs() < 1e-12);
}

#[test]
fn arc_length_parametrises_every_shape() {
    for shape in shapes() {
        let curve = curve(shape);
        let step = 1e-5;
        for i in 1..200 {
            let s = curve.length() * f64::from(i) / 200.0;
            let (here, next) = (curve.at(s), curve.at(s + step));
            assert!((here.tangent.norm() - 1.0).abs() < 1e-14);
            let advance = (next.point - here.point) / step;
            if (next.tangent - here.tangent).norm() < 1e-3 {
                assert!((advance - here.tangent).norm() < 1e-3, "{s}");
                let turn = here.tangent.perp(&next.tangent) / step;
                assert!((turn - here.curvature).abs() < 1e-2 * (1.0 + here.curvature.abs()), "{s}");
            }
            let foot = curve.track(here.point, s);
            assert!((foot.arc_length - s).abs() < 1e-9 && foot.distance < 1e-9);
        }
    }
}

#[test]
fn open_ends_extend_along_the_tangent() {
    let arc = CurveShape::Arc { centre: at(0.0, 0.0), radius: 1.0, start_angle: 0.0, sweep: FRAC_PI_2 };
    let queue = Curve::new(&arc, true, true).unwrap();
    assert!((queue.at(-2.0).point - at(1.0, -2.0)).norm() < 1e-15);
    let beyond = queue.nearest(at(-3.0, 1.5));
    assert!((beyond.point - at(-3.0, 1.0)).norm() < 1e-12);
    assert!((beyond.arc_length - (FRAC_PI_2 + 3.0)).abs() < 1e-12);
    assert_eq!(queue.track(at(-3.0, 1.5), 0.1), beyond);
    assert_eq!(queue.nearest_all(at(0.5, -1.0)).feet.len(), 1);
    let closed = Curve::new(&arc, false, false).unwrap();
    assert!((closed.nearest(at(-3.0, 1.5)).point - at(0.0, 1.0)).norm() < 1e-15);
    assert!((closed.at(99.0).point - at(0.0, 1.0)).norm() < 1e-15);
}

#[test]
fn a_moving_frame_carries_the_curve() {
    let curve = parabola();
    let frame = Isometry2::new(at(2.0, -1.0), 0.7);
    let placed = Placed::new(&curve, frame);
    let point = at(0.3, 1.7);
    let moved = frame.transform_point(&point.into()).coords;
    let (here, there) = (curve.nearest(point), placed.nearest(moved));
    assert!((there.arc_length - here.arc_length).abs() < 1e-12);
    assert!((frame.transform_point(&here.point.into()).coords - there.point).norm() < 1e-12);
    assert!((placed.at(1.0).tangent - frame.rotation * curve.at(1.0).tangent).norm() < 1e-15);
    assert_eq!(placed.nearest_all(moved).feet.len(), 1);
}

#[test]
fn unusable_descriptions_are_refused() {
    let check = |shape: CurveShape, expected: &str| {
        let error = Curve::new(&shape, false, false).unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
    };
    check(CurveShape::Line(at(1.0, 1.0), at(1.0, 1.0)), "points 0 and 1 coincide");
    check(CurveShape::Line(at(f64::NAN, 1.0), at(1.0, 1.0)), "not a finite number");
    check(CurveShape::Polyline(vec![at(0.0, 0.0)]), "a polyline has 1 points but needs two or more");
    check(CurveShape::Bezier(vec![at(0.0, 0.0); 5]), "needs 4, 7, 10");
    check(CurveShape::Bezier(vec![at(0.0, 0.0); 4]), "cusp");
    let back = vec![at(0.0, 0.0), at(1.0, 0.0), at(0.5, 0.0)];
    check(CurveShape::Polyline(back), "cusp");
    let crossing = vec![at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.5, -1.0)];
    check(CurveShape::Polyline(crossing), "meets itself after 0.75 m and after 3.03");
    let knot = vec![at(0.0, 0.0), at(3.0, 2.0), at(-2.0, 2.0), at(1.0, 0.0)];
    check(CurveShape::Bezier(knot), "meets itself");
    let arc = |radius, sweep| CurveShape::Arc { centre: at(0.0, 0.0), radius, start_angle: 0.0, sweep };
    check(arc(-1.0, 1.0), "radius is -1, but must be greater than zero");
    check(arc(1.0, 0.0), "sweep is 0 rad");
    check(arc(1.0, 7.0), "sweep is 7 rad");
    let circle = Curve::new(&arc(1.0, TAU), true, false);
    assert_eq!(circle, Err(CurveError::ClosedCurveExtended));
}

proptest! {
    /// What the last answer proved has no influence on the next: along any way, near or far, over any joint, across any tie.
    #[test]
    fn asked_again_is_asked_anew(
        shape in 0..9_usize, x in -3.0..3.0_f64, y in -3.0..3.0_f64,
        moves in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 60), pace in 0.0..0.5_f64,
    ) {
        let (curve, other) = (curve(shapes()[shape].clone()), parabola());
        let (mut point, mut warm) = (at(x, y), Warm::default());
        for (index, (x, y)) in moves.into_iter().enumerate() {
            prop_assert_eq!(curve.nearest_again(point, &mut warm), curve.nearest(point));
            if index % 20 == 19 {
                prop_assert_eq!(other.nearest_again(point, &mut warm), other.nearest(point));
            }
            point += pace * at(x, y);
        }
    }

    #[test]
    fn nearest_is_the_global_minimum(index in 0..9_usize, x in -3.0..3.0_f64, y in -3.0..3.0_f64) {
        let curve = curve(shapes()[index].clone());
        let point = at(x, y);
        let foot = curve.nearest(point);
        let samples = 4000;
        let sampled = (0..=samples)
            .map(|i| (curve.at(curve.length() * f64::from(i) / f64::from(samples)).point - point).norm())
            .fold(f64::INFINITY, f64::min);
        prop_assert!(foot.distance <= sampled + 1e-12);
        prop_assert!(foot.distance >= sampled - curve.length() / f64::from(samples));
        prop_assert!((curve.at(foot.arc_length).point - foot.point).norm() < 1e-12);
        let set = curve.nearest_all(point);
        prop_assert!(set.feet.iter().any(|other| (other.point - foot.point).norm() < 1e-9));
        prop_assert!(set.feet.iter().all(|other| other.distance < foot.distance + 2e-9 * (1.0 + foot.distance)));
        let end = foot.arc_length == 0.0 || foot.arc_length == curve.length();
        if !end && foot.distance > 1e-6 && index != 1 && index != 2 {
            let cosine = (point - foot.point).dot(&foot.tangent) / foot.distance;
            prop_assert!(cosine.abs() < 1e-7);
        }
    }
}
