//! Whether two convex polygons are nearer to each other than a limit, without their distance: E. G. Gilbert, D. W. Johnson and S. S.
//! Keerthi, "A fast procedure for computing the distance between complex objects in three-dimensional space" (1988), in the plane.
use nalgebra::Vector2;

type Point = Vector2<f64>;

/// So many corners are looked for at most; a handful is enough but where rounding decides.
const MOST_STEPS: usize = 24;
/// What is left of a squared distance to gain is rounding.
const GAINED: f64 = 1e-12;

/// Whether the distance between the polygons of these corners is strictly below `limit` (m). `arm` leads from a point of `a` to one of
/// `b`. Nothing where rounding decides.
///
/// The differences b - a form a polygon too, whose distance from the origin is that between `a` and `b`. It is approached corner by corner:
/// any of its points is as far or farther, any line across the way to one that has all of it beyond is as near or nearer.
pub(super) fn is_nearer(a: &[Point], b: &[Point], arm: Point, limit: f64) -> Option<bool> {
    // The nearest point so far, and the edge of differences that it is on.
    let (mut nearest, mut edge) = (arm, [arm, arm]);
    for _ in 0..MOST_STEPS {
        let squared = nearest.norm_squared();
        if squared < limit * limit {
            return Some(true);
        }
        let corner = lowest(b, nearest) - lowest(a, -nearest);
        let height = corner.dot(&nearest);
        if height > 0.0 && height * height >= limit * limit * squared {
            return Some(false);
        }
        if squared - height <= GAINED * squared {
            return None;
        }
        let [start, end] = edge;
        let side = |from: Point, to: Point| (to - from).perp(&-from);
        let sides = [side(start, end), side(end, corner), side(corner, start)];
        if sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0) {
            return Some(limit > 0.0);
        }
        let (to_start, to_end) = (nearest_between(start, corner), nearest_between(end, corner));
        let by_start = to_start.norm_squared() < to_end.norm_squared();
        (nearest, edge) = if by_start { (to_start, [start, corner]) } else { (to_end, [end, corner]) };
    }
    None
}

/// The corner that lies lowest along `direction`.
fn lowest(points: &[Point], direction: Point) -> Point {
    let mut best = (f64::INFINITY, Point::zeros());
    for point in points {
        let height = point.dot(&direction);
        if height < best.0 {
            best = (height, *point);
        }
    }
    best.1
}

/// The point of a straight piece that is nearest to the origin.
fn nearest_between(start: Point, end: Point) -> Point {
    let along = end - start;
    let squared = along.norm_squared();
    let fraction = if squared > 0.0 { (-start.dot(&along) / squared).clamp(0.0, 1.0) } else { 0.0 };
    start + fraction * along
}

#[cfg(test)]
mod tests {
    use crate::Vector2;
    use crate::hull::Shape;
    use proptest::prelude::*;

    fn shape() -> impl Strategy<Value = Shape> {
        let points = prop::collection::vec((-4.0..4.0_f64, -4.0..4.0_f64), 1..9);
        let placed = (points, -6.0..6.0_f64, -6.0..6.0_f64, 0.0..0.5_f64);
        placed.prop_map(|(points, x, y, radius)| {
            let points: Vec<Vector2<f64>> = points.iter().map(|(a, b)| Vector2::new(a + x, b + y)).collect();
            Shape::enclosing(&points, radius).unwrap()
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        /// What is nearer than a limit has a gap below it.
        #[test]
        fn it_agrees_with_the_gap(a in shape(), b in shape(), limit in 0.0..6.0_f64) {
            let (a, b) = (a.outline(), b.outline());
            let gap = a.gap(&b);
            prop_assume!((gap - limit).abs() > 1e-9);
            prop_assert_eq!(a.is_nearer_than(&b, limit), gap < limit);
            prop_assert_eq!(b.is_nearer_than(&a, limit), gap < limit);
        }
    }

    #[test]
    fn corners_edges_and_overlaps() {
        let shape = |points: &[[f64; 2]]| {
            let points: Vec<Vector2<f64>> = points.iter().copied().map(Vector2::from).collect();
            Shape::enclosing(&points, 0.0).unwrap()
        };
        let square = shape(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
        let check = |other: &Shape, limit: f64, expected: bool| {
            assert_eq!(square.outline().is_nearer_than(&other.outline(), limit), expected, "{other:?} {limit}");
        };
        let diamond = shape(&[[4.0, 1.0], [5.0, 0.0], [6.0, 1.0], [5.0, 2.0]]);
        check(&diamond, 2.0, false);
        check(&diamond, 2.0 + 1e-9, true);
        check(&shape(&[[1.0, 1.0]]), 0.5, true);
        check(&shape(&[[1.0, 1.0]]), 0.0, false);
        check(&shape(&[[-1.0, 1.0], [3.0, 1.0]]), 0.1, true);
        check(&shape(&[[2.0, 5.0], [5.0, 2.0]]), 2.0_f64.sqrt() * 1.5 - 1e-9, false);
        check(&shape(&[[2.0, 5.0], [5.0, 2.0]]), 2.0_f64.sqrt() * 1.5 + 1e-9, true);
    }
}
