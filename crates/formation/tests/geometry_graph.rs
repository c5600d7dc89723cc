//! Curves y = f(x): certified nearest points, against closed forms, built-in shapes and dense sampling.
#![expect(clippy::unwrap_used, reason = "a failed construction is a failed test")]
use core::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};
use proptest::prelude::*;
use trench_expression::Expression;
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveShape};

fn graph(text: &str, from: f64, to: f64) -> CurveShape {
    CurveShape::Graph { function: Expression::parse(text).unwrap(), from, to }
}

fn curve(text: &str, from: f64, to: f64) -> Curve {
    Curve::new(&graph(text, from, to), false, false).unwrap()
}

#[test]
fn nearest_points_of_the_parabola() {
    let parabola = curve("x^2", -3.0, 3.0);
    for height in [0.51, 0.75, 1.0, 2.5, 6.0] {
        let set = parabola.nearest_all(Vector2::new(0.0, height));
        let x = (height - 0.5_f64).sqrt();
        assert_eq!(set.feet.len(), 2, "{set:?}");
        for (foot, expected) in set.feet.iter().zip([-x, x]) {
            assert!((foot.point - Vector2::new(expected, x * x)).norm() < 1e-9, "{foot:?}");
            assert!((foot.distance - (height - 0.25).sqrt()).abs() < 1e-9);
        }
    }
    for height in [-1.0, 0.2, 0.49] {
        let set = parabola.nearest_all(Vector2::new(0.0, height));
        assert_eq!(set.feet.len(), 1, "{set:?}");
        assert!(set.feet[0].point.norm() < 1e-9);
    }
}

#[test]
fn nearest_points_of_the_sine() {
    let set = curve("sin(x)", -TAU, TAU).nearest_all(Vector2::new(FRAC_PI_2, -FRAC_PI_2));
    assert_eq!(set.feet.len(), 2, "{set:?}");
    for (foot, x) in set.feet.iter().zip([0.0, PI]) {
        assert!((foot.point - Vector2::new(x, 0.0)).norm() < 1e-9, "{foot:?}");
        assert!((foot.distance - PI / SQRT_2).abs() < 1e-9);
    }
}

#[test]
fn unusable_expressions_are_refused() {
    let check = |text: &str, from: f64, to: f64, expected: &str| {
        let error = Curve::new(&graph(text, from, to), false, false).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    };
    check("1/x", -1.0, 1.0, "is not finite at x = 0 (the division at column 2)");
    check("1/x", 0.0, 1.0, "is not finite at x = 0");
    check("sqrt(x)", -1.0, 1.0, "is not finite at x = -1 (sqrt at column 1)");
    check("sqrt(x)", -5.0, 100.0, "is not finite at x = -5 (sqrt at column 1)");
    check("sqrt(x)", 0.0, 1.0, "infinitely steep at x = 0");
    check("2 + abs(x - 0.25)", -1.0, 1.0, "is not twice differentiable at x = 0.25 (abs at column 5): end the segment");
    check("x * sign(x)", -1.0, 1.0, "jumps or is infinitely steep at x = 0 (sign at column 5)");
    check("max(0, x)^2", -1.0, 1.0, "is not twice differentiable at x = 0");
    // They are, but intervals cannot tell.
    let unknown = "could not be shown to be twice differentiable at x = 0 (abs at column";
    check("x^2*abs(x)", -1.0, 1.0, unknown);
    check("abs(x)^3", -1.0, 1.0, unknown);
    assert!(Curve::new(&graph("x^2*sqrt(x^2 + 1e-6)", -1.0, 1.0), false, false).is_ok(), "the remedy");
    check("x", 1.0, 1.0, "but must go to a greater x");
    check("x", 0.0, f64::NAN, "the last x is not a finite number");
    assert!(Curve::new(&graph("abs(x)", 0.0, 1.0), false, false).is_ok(), "the kink is the end");
}

const SHAPES: [(&str, f64, f64); 8] = [
    ("x^2", -1.5, 1.5),
    ("sin(3*x)", -2.0, 2.0),
    ("0.3*x^3 - x", -2.5, 2.5),
    ("exp(-4*x^2)", -2.0, 2.0),
    ("tanh(8*x)", -1.0, 1.0),
    ("0.5*cos(2*pi*x) + 0.1*x", -1.3, 1.7),
    ("ln(x + 3) * sqrt(4 - x)", -2.0, 3.0),
    ("1.2", -1.0, 2.0),
];

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// No minimum is missed: no sample is nearer, and every local minimum of the samples on a par is in the set.
    #[test]
    fn nearest_is_the_global_minimum(index in 0..SHAPES.len(), x in -3.0..3.0_f64, y in -3.0..3.0_f64) {
        let (text, from, to) = SHAPES[index];
        let (curve, point) = (curve(text, from, to), Vector2::new(x, y));
        let function = Expression::parse(text).unwrap();
        let at = |i: i32| {
            let x = (from + (to - from) * f64::from(i) / 8000.0).min(to);
            Vector2::new(x, function.value(x))
        };
        let foot = curve.nearest(point);
        let set = curve.nearest_all(point);
        for i in 0..=8000 {
            let distance = (at(i) - point).norm();
            prop_assert!(foot.distance <= distance + 1e-12);
            // What is as near as the nearest point lies beside one of them.
            if distance < foot.distance + 1e-7 {
                prop_assert!(set.feet.iter().any(|foot| (foot.point - at(i)).norm() < 0.05), "{text} {point:?}");
            }
        }
        prop_assert!((function.value(foot.point.x) - foot.point.y).abs() < 1e-12);
        prop_assert!((curve.at(foot.arc_length).point - foot.point).norm() < 1e-12);
        let is_end = foot.point.x == from || foot.point.x == to;
        if !is_end && foot.distance > 1e-6 {
            prop_assert!(((point - foot.point).dot(&foot.tangent) / foot.distance).abs() < 1e-7);
        }
    }

    /// An expression and the built-in sinusoid are the same curve.
    #[test]
    fn the_sinusoid_as_an_expression(x in -1.0..4.0_f64, y in -2.0..2.0_f64) {
        let written = curve("0.4*sin(2*pi*x/1.5 + 0.3)", 0.0, 3.0);
        let built_in = CurveShape::Sinusoid {
            origin: Vector2::zeros(), direction: 0.0, length: 3.0, amplitude: 0.4, wavelength: 1.5, phase: 0.3,
        };
        let built_in = Curve::new(&built_in, false, false).unwrap();
        let point = Vector2::new(x, y);
        let (written, built_in) = ((written.length(), written.nearest(point)), (built_in.length(), built_in.nearest(point)));
        prop_assert!((written.0 - built_in.0).abs() < 1e-12);
        prop_assert!((written.1.distance - built_in.1.distance).abs() < 1e-12);
        prop_assert!((written.1.point - built_in.1.point).norm() < 1e-7);
        prop_assert!((written.1.curvature - built_in.1.curvature).abs() < 1e-5);
    }
}

/// Points of attraction (6.3) and projections, against closed forms and sampling.
#[test]
fn curves_seen_along_a_direction() {
    let wave = curve("sin(x)", -TAU, TAU);
    let (up, right) = (Vector2::new(0.0, 1.0), Vector2::new(1.0, 0.0));
    let (low, high) = wave.extent(up);
    assert!((low + 1.0).abs() < 1e-10 && (high - 1.0).abs() < 1e-10);
    assert_eq!(wave.extent(right), (-TAU, TAU));
    let met = wave.met_along(Vector2::new(0.7, 5.0), -up);
    assert_eq!(met.len(), 1);
    assert!(
        (met[0].point - Vector2::new(0.7, libm::sin(0.7))).norm() < 1e-9
            && (met[0].distance - (5.0 - libm::sin(0.7))).abs() < 1e-9
    );
    let zeros: Vec<f64> = wave.met_along(Vector2::new(50.0, 0.0), right).iter().map(|foot| foot.point.x).collect();
    assert_eq!(zeros.len(), 5, "{zeros:?}");
    assert!(zeros.iter().zip([-TAU, -PI, 0.0, PI, TAU]).all(|(found, x)| (found - x).abs() < 1e-9), "{zeros:?}");
    assert!(wave.met_along(Vector2::new(0.0, 1.5), right).is_empty());
    let open = Curve::new(&CurveShape::Line(Vector2::zeros(), right), false, true).unwrap();
    assert_eq!(open.extent(right), (0.0, f64::INFINITY));
    let beyond = open.met_along(Vector2::new(3.0, 2.0), -up);
    assert!(
        beyond.len() == 1 && (beyond[0].arc_length - 3.0).abs() < 1e-12 && (beyond[0].distance - 2.0).abs() < 1e-12
    );
    assert!(open.met_along(Vector2::new(-1.0, 2.0), -up).is_empty());
}
