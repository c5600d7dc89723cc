//! Where places with several nearest points begin, and how nearly curves run along a direction.
#![expect(clippy::unwrap_used, reason = "a failed construction is a failed test")]
use core::f64::consts::{FRAC_PI_2, PI, TAU};
use proptest::prelude::*;
use trench_expression::Expression;
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveShape, Reach};

fn curve(shape: CurveShape) -> Curve {
    Curve::new(&shape, false, false).unwrap()
}

fn graph(text: &str, from: f64, to: f64) -> Curve {
    curve(CurveShape::Graph { function: Expression::parse(text).unwrap(), from, to })
}

fn at(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

/// What was found, with the place looked at again.
fn reach(curve: &Curve) -> Reach {
    let found = curve.reach().unwrap();
    let nearest = curve.nearest(found.place);
    assert!((nearest.distance - found.distance).abs() < 1e-6 * (1.0 + found.distance), "{found:?} {nearest:?}");
    for foot in found.feet {
        assert!(
            ((foot.point - found.place).norm() - found.distance).abs() < 1e-6 * (1.0 + found.distance),
            "{found:?}"
        );
    }
    found
}

#[test]
fn straight_segments_have_no_transits() {
    assert_eq!(curve(CurveShape::Line(at(1.0, 2.0), at(30.0, -4.0))).reach(), None);
    let open = Curve::new(&CurveShape::Line(at(1.0, 2.0), at(30.0, -4.0)), true, true).unwrap();
    assert_eq!(open.reach(), None);
}

/// The centre of curvature of y = x^2 at its vertex is (0, 1/2).
#[test]
fn the_parabola_from_its_centre_of_curvature_on() {
    let found = reach(&graph("x^2", -3.0, 3.0));
    assert!((found.distance - 0.5).abs() < 1e-4 && (found.place - at(0.0, 0.5)).norm() < 1e-3, "{found:?}");
}

#[test]
fn the_centre_of_a_circle_and_the_focal_points_of_an_ellipse() {
    let circle = curve(CurveShape::Arc { centre: at(1.0, 2.0), radius: 5.0, start_angle: 0.4, sweep: TAU });
    let found = reach(&circle);
    assert!((found.distance - 5.0).abs() < 1e-6 && (found.place - at(1.0, 2.0)).norm() < 1e-5, "{found:?}");
    // b^2/a, at the ends of the long axis.
    let found = reach(&curve(CurveShape::Ellipse { centre: at(0.0, 0.0), semi_axes: [3.0, 1.0], rotation: 0.0 }));
    assert!((found.distance - 1.0 / 3.0).abs() < 1e-4, "{found:?}");
}

/// A corner has places with two nearest points at any distance.
#[test]
fn corners_have_transits_at_once() {
    let found = reach(&curve(CurveShape::Polyline(vec![at(0.0, 0.0), at(4.0, 0.0), at(4.0, 3.0)])));
    assert!(found.distance == 0.0 && found.place == at(4.0, 0.0), "{found:?}");
}

/// Two strands that run side by side, and the ends of an arc that nearly meet, count before the bends do.
#[test]
fn strands_and_ends_near_each_other() {
    let gap = 0.4;
    let sweep = TAU - gap / 5.0;
    let found = reach(&curve(CurveShape::Arc { centre: at(0.0, 0.0), radius: 5.0, start_angle: 0.0, sweep }));
    let half = 5.0 * (0.5 * (TAU - sweep)).sin();
    assert!((found.distance - half).abs() < 1e-9, "{found:?} {half}");
    // Between the waves of a steep sine: its bends have the radius 1/(A k^2) = 1/9.
    let wave = reach(&graph("sin(3*x)", 0.0, TAU));
    assert!((wave.distance - 1.0 / 9.0).abs() < 1e-4, "{wave:?}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    /// Nearer than that every place has one nearest point, and no short way has a transit.
    #[test]
    fn nearer_places_have_one_nearest_point(
        amplitude in 0.2..2.0_f64, share in 0.0..1.0_f64, off in -0.97..0.97_f64, angle in 0.0..TAU,
    ) {
        let wave = graph(&format!("{amplitude}*sin(x)"), -PI, 2.0 * PI);
        let found = reach(&wave);
        let foot = wave.at(share * wave.length());
        let place = foot.point + off * found.distance * at(-foot.tangent.y, foot.tangent.x);
        prop_assert_eq!(wave.nearest_all(place).feet.len(), 1, "{:?}", found);
        let room = found.distance * (1.0 - off.abs());
        let way = place + 0.9 * room * at(angle.cos(), angle.sin());
        prop_assert_eq!(wave.transit(place, way, 0.05), None);
    }

    /// No point has a smaller sine, and some have one that is hardly larger.
    #[test]
    fn the_least_sine_is_a_bound(amplitude in 0.1..2.0_f64, number in 0.3..3.0_f64, angle in 0.0..PI) {
        let (wave, along) = (graph(&format!("{amplitude}*sin({number}*x)"), -2.0, 5.0), at(angle.cos(), angle.sin()));
        let bound = wave.least_sine(3.0 * along);
        let sine = |index: u32| wave.at(wave.length() * f64::from(index) / 20_000.0).tangent.perp(&along).abs();
        let seen = (0..=20_000).map(sine).fold(1.0, f64::min);
        // Half a sample's way at the greatest curvature, A k^2.
        let missed = 0.5 * wave.length() / 20_000.0 * amplitude * number * number;
        prop_assert!(bound <= seen && seen - bound < missed + 2e-6, "{} {}", bound, seen);
    }
}

/// A bump of millimetres on a hundred metres: a thousand points look past it, and see a segment across the direction.
#[test]
fn what_samples_miss_is_bounded() {
    let bump = graph("0.004*exp(-((x-50.05)/0.001)^2)", 0.0, 100.0);
    let steep = 0.004 / 0.001 * (2.0_f64.sqrt() * (-0.5_f64).exp());
    let along = at(1.0, 0.9 * steep).normalize();
    let sine = |index: u32| bump.at(bump.length() * f64::from(index) / 1000.0).tangent.perp(&along).abs();
    let sampled = (0..=1000).map(sine).fold(1.0, f64::min);
    assert!(sampled > 0.9, "the samples miss it: {sampled}");
    let bound = bump.least_sine(along);
    assert!(bound < 1e-5, "{bound}");
    // And where nothing is along the direction, the bound is that angle.
    let across = graph("0.1*x", 0.0, 10.0).least_sine(at(0.0, 1.0));
    assert!((across - (FRAC_PI_2 - 0.1_f64.atan()).sin()).abs() < 2e-6, "{across}");
}
