//! Convex hull of points (A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979).
use nalgebra::Vector2;

/// Sorts `points` and replaces them by their convex hull: counter-clockwise, from the leftmost (then lowest) corner, no
/// corner on the line between its neighbours. The result does not depend on the order of the points.
pub(super) fn convex_hull(points: &mut Vec<Vector2<f64>>) {
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return;
    }
    let mut hull: Vec<Vector2<f64>> = Vec::with_capacity(points.len() + 1);
    let mut chain = |points: &mut dyn Iterator<Item = Vector2<f64>>| {
        let base = hull.len();
        for point in points {
            while hull.len() >= base + 2 && !turns_left(hull[hull.len() - 2], hull[hull.len() - 1], point) {
                hull.pop();
            }
            hull.push(point);
        }
        hull.pop(); // it begins the other chain
    };
    chain(&mut points.iter().copied());
    chain(&mut points.iter().rev().copied());
    *points = hull;
}

fn turns_left(a: Vector2<f64>, b: Vector2<f64>, c: Vector2<f64>) -> bool {
    (b - a).perp(&(c - a)) > 0.0
}
