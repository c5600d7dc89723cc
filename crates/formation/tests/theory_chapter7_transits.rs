//! Transits of nearest points (7.2.4, Definition 7.2.1).
#![expect(clippy::unwrap_used, reason = "a failed construction is a failed test")]
use core::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};
use nalgebra::Isometry2;
use proptest::prelude::*;
use trench_expression::Expression;
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveShape, Placed, Transit};

/// m, between transit points at least.
const APART: f64 = 0.01;

fn curve(text: &str, from: f64, to: f64) -> Curve {
    let function = Expression::parse(text).unwrap();
    Curve::new(&CurveShape::Graph { function, from, to }, false, false).unwrap()
}

fn transit(curve: &Curve, from: [f64; 2], to: [f64; 2]) -> Option<Transit> {
    curve.transit(Vector2::from(from), Vector2::from(to), APART)
}

fn assert_at(found: Option<Transit>, place: [f64; 2], from: [f64; 2], to: [f64; 2]) {
    let found = found.unwrap();
    for (point, expected) in [(found.place, place), (found.from.point, from), (found.to.point, to)] {
        assert!((point - Vector2::from(expected)).norm() < 1e-6, "{found:?}");
    }
    let (near, far) = (found.from.distance, found.to.distance);
    assert!((near - far).abs() < 1e-6, "(i): both are nearest points of P: {found:?}");
}

/// Trajectory I of Fig. 7.3 over y = x^2: on the axis, above the centre of curvature (0, 1/2), the nearest points are +-sqrt(h - 1/2).
#[test]
fn the_parabola_has_transits_above_its_centre_of_curvature() {
    let parabola = curve("x^2", -3.0, 3.0);
    let x = 1.5_f64.sqrt();
    assert_at(transit(&parabola, [-0.3, 2.0], [0.4, 2.0]), [0.0, 2.0], [-x, 1.5], [x, 1.5]);
    assert_at(transit(&parabola, [0.4, 2.0], [-0.3, 2.0]), [0.0, 2.0], [x, 1.5], [-x, 1.5]);
    assert_eq!(
        transit(&parabola, [-0.3, 0.45], [0.4, 0.45]),
        None,
        "below it the nearest point is unique and passes 0"
    );
    assert_eq!(transit(&parabola, [-1.0, 2.0], [-0.1, 2.0]), None, "not yet there");
}

/// Trajectory II: there are two nearest points on its way, and no transit (the remark behind Definition 7.2.1).
#[test]
fn several_nearest_points_are_no_transit() {
    let parabola = curve("x^2", -3.0, 3.0);
    assert_eq!(parabola.nearest_all(Vector2::new(0.0, 2.0)).feet.len(), 2);
    for (from, to) in
        [([-0.5, 2.0], [0.0, 2.0]), ([0.0, 2.0], [-0.5, 2.5]), ([0.0, 2.0], [0.5, 1.0]), ([0.0, 3.0], [0.0, 1.0])]
    {
        assert_eq!(transit(&parabola, from, to), None, "{from:?} to {to:?}");
    }
}

#[test]
fn the_sine_has_its_transit_where_its_values_are_known() {
    let found = transit(&curve("sin(x)", -TAU, TAU), [1.2, -FRAC_PI_2], [1.9, -FRAC_PI_2]);
    assert_at(found, [FRAC_PI_2, -FRAC_PI_2], [0.0, 0.0], [PI, 0.0]);
    let distance = found.unwrap().from.distance;
    assert!((distance - PI / SQRT_2).abs() < 1e-6, "{distance}");
}

/// Of several on a way it is the first; the second is found from behind it.
#[test]
fn the_first_transit_of_a_way() {
    let wave = curve("sin(x)", -TAU, 2.0 * TAU);
    let first = transit(&wave, [1.0, -2.0], [9.0, -2.0]).unwrap();
    assert!((first.place.x - FRAC_PI_2).abs() < 1e-6, "{first:?}");
    let second = transit(&wave, [first.place.x + 1e-3, -2.0], [9.0, -2.0]).unwrap();
    assert!((second.place.x - FRAC_PI_2 - TAU).abs() < 1e-6, "{second:?}");
}

/// Seen from the frame in which the segment's own frame has a pose.
#[test]
fn transits_in_the_map() {
    let parabola = curve("x^2", -3.0, 3.0);
    let placed = Placed::new(&parabola, Isometry2::new(Vector2::new(5.0, 1.0), FRAC_PI_2));
    // x of the segment goes up, its y to the left.
    let found = placed.transit(Vector2::new(3.0, 0.7), Vector2::new(3.0, 1.4), APART);
    let x = 1.5_f64.sqrt();
    assert_at(found, [3.0, 1.0], [3.5, 1.0 - x], [3.5, 1.0 + x]);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// Proposition 7.2.3: transit points exist only where the nearest point is not unique; and where no transit is seen on a short way,
    /// the nearest point has moved no farther than it can without one.
    #[test]
    fn transit_points_are_where_the_nearest_point_is_not_unique(
        x in -2.0..2.0_f64, y in -0.5..4.0_f64, angle in 0.0..TAU, length in 0.05..1.0_f64,
    ) {
        let parabola = curve("x^2", -3.0, 3.0);
        let (from, way) = (Vector2::new(x, y), length * Vector2::new(angle.cos(), angle.sin()));
        let height = y - x / way.x * way.y;
        let (meets, at_the_centre) = (x * (x + way.x) < 0.0, (0.5..0.51).contains(&height));
        // There nearest points are less than `APART` from each other, or as good as.
        prop_assume!(!(meets && at_the_centre));
        let crosses = meets && height > 0.5;
        let found = parabola.transit(from, from + way, APART);
        prop_assert_eq!(found.is_some(), crosses, "{:?}", found);
        if let Some(found) = found {
            // Distances that differ by 1e-9 (1 m + distance) count as equal.
            prop_assert!(found.place.x.abs() < 1e-7, "{found:?}");
            prop_assert_eq!(parabola.nearest_all(Vector2::new(0.0, found.place.y)).feet.len(), 2);
        }
    }
}
