//! Hulls and distances against parry, which computes them by other means (GJK, its own hull).
#![expect(clippy::unwrap_used, reason = "a failed construction is a failed test")]

use nalgebra::Vector2;
use parry2d_f64::math::{Pose, Vector};
use parry2d_f64::query;
use parry2d_f64::shape::{ConvexPolygon, Shape as _};
use proptest::prelude::*;
use trench_formation::hull::{Obstacle, Shape, combine};

/// parry's types are glam's: the only place where points change hands.
fn to_parry(points: &[Vector2<f64>]) -> Vec<Vector> {
    points.iter().map(|point| Vector::new(point.x, point.y)).collect()
}

/// Three corners in general position and more, about `centre`: in order around it, so the polygon is simple.
fn polygon(centre: (f64, f64)) -> impl Strategy<Value = Vec<Vector2<f64>>> {
    proptest::collection::vec((0.0..1.0_f64, 0.2..1.0_f64), 4..9).prop_map(move |corners| {
        let count = corners.len() as f64;
        let corner = |(index, (shift, radius)): (usize, &(f64, f64))| {
            let angle = std::f64::consts::TAU * (index as f64 + 0.8 * shift) / count;
            Vector2::new(centre.0 + radius * angle.cos(), centre.1 + radius * angle.sin())
        };
        corners.iter().enumerate().map(corner).collect()
    })
}

/// parry drops corners of a hull at which its edge turns by less than this, rad: 1 - cos is below the root of epsilon there.
const DROPPED: f64 = 1.8e-4;

/// Whether parry's hull keeps every corner of ours.
fn all_kept(points: &[Vector2<f64>]) -> bool {
    let shape = Shape::new(points, 0.0).unwrap();
    let corners = shape.outline().points;
    let edge = |index: usize| corners[(index + 1) % corners.len()] - corners[index % corners.len()];
    (0..corners.len())
        .all(|index| edge(index).perp(&edge(index + 1)).atan2(edge(index).dot(&edge(index + 1))) > DROPPED)
}

/// A corner that hardly turns belongs to the hull: the area with it is the right one, and parry's is without it.
#[test]
fn parry_drops_corners_that_hardly_turn() {
    let area = |height: f64| {
        let points = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.5, 1.0 + height), (0.0, 1.0)];
        let points = points.map(|(x, y)| Vector2::new(x, y));
        let theirs = ConvexPolygon::from_convex_hull(&to_parry(&points)).unwrap().mass_properties(1.0).mass();
        (Shape::new(&points, 0.0).unwrap().area(), theirs)
    };
    // The upper corner of the triangle on top of the square turns by four times the height: 1.6e-4 rad and 4e-3 rad.
    for (height, kept) in [(4e-5, false), (1e-3, true)] {
        let (ours, theirs) = area(height);
        assert!((ours - (1.0 + 0.5 * height)).abs() < 1e-12, "{ours}");
        let expected = if kept { ours } else { 1.0 };
        assert!((theirs - expected).abs() < 1e-9, "{theirs}");
    }
}

proptest! {
    #[test]
    fn hulls_have_parry_s_area(points in polygon((0.0, 0.0))) {
        prop_assume!(all_kept(&points));
        let ours = Shape::new(&points, 0.0).unwrap();
        let theirs = ConvexPolygon::from_convex_hull(&to_parry(&points)).unwrap();
        let area = theirs.mass_properties(1.0).mass();
        prop_assert!((ours.area() - area).abs() < 1e-9, "{} and {area}", ours.area());
    }

    #[test]
    fn separations_are_parry_s(
        a in polygon((0.0, 0.0)), b in polygon((2.5, 0.4)), radius_a in 0.0..0.3_f64, radius_b in 0.0..0.2_f64,
    ) {
        prop_assume!(all_kept(&a) && all_kept(&b));
        let (ours_a, ours_b) = (Shape::new(&a, radius_a).unwrap(), Shape::new(&b, radius_b).unwrap());
        let hull = |points: &[Vector2<f64>]| ConvexPolygon::from_convex_hull(&to_parry(points)).unwrap();
        let distance = query::distance(&Pose::IDENTITY, &hull(&a), &Pose::IDENTITY, &hull(&b)).unwrap().distance;
        let gap = ours_a.outline().gap(&ours_b.outline());
        let expected = distance - radius_a - radius_b;
        prop_assert!((gap - expected).abs() < 1e-6, "{gap} and {expected}");
    }

    /// Whether two obstacles are combined is decided by parry's distance against the clearance.
    #[test]
    fn they_are_combined_below_the_clearance(a in polygon((0.0, 0.0)), b in polygon((2.3, 0.0)), clearance in 0.1..1.5_f64) {
        prop_assume!(all_kept(&a) && all_kept(&b));
        let hull = |points: &[Vector2<f64>]| ConvexPolygon::from_convex_hull(&to_parry(points)).unwrap();
        let distance = query::distance(&Pose::IDENTITY, &hull(&a), &Pose::IDENTITY, &hull(&b)).unwrap().distance;
        prop_assume!((distance - clearance).abs() > 1e-6);
        let obstacles = [(1, &a), (2, &b)].map(|(id, points)| Obstacle { id, shape: Shape::new(points, 0.0).unwrap() });
        let combined = combine(&obstacles, clearance).unwrap();
        prop_assert_eq!(combined.len(), if distance < clearance { 1 } else { 2 }, "{} apart", distance);
    }
}
