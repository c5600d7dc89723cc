//! Boundaries of grown polygons, for those who draw them.

use std::f64::consts::TAU;
use trench_formation::Vector2;

/// Directions in which a rounded corner is looked at.
const DIRECTIONS: usize = 72;

/// The boundary of the convex polygon `points` (counter-clockwise; one point is a disc, two are a wall) grown by `radius` (m),
/// closed: the farthest point in each of many directions, with the polygon's own corners where it is not grown.
pub(crate) fn rounded(points: &[Vector2<f64>], radius: f64) -> Vec<Vector2<f64>> {
    let mut boundary: Vec<Vector2<f64>> = if radius == 0.0 {
        points.to_vec()
    } else {
        let farthest = |step: usize| {
            let (sine, cosine) = (TAU * step as f64 / DIRECTIONS as f64).sin_cos();
            let direction = Vector2::new(cosine, sine);
            let corner =
                points.iter().copied().reduce(|a, b| if b.dot(&direction) > a.dot(&direction) { b } else { a });
            corner.map(|corner| corner + radius * direction)
        };
        (0..DIRECTIONS).filter_map(farthest).collect()
    };
    boundary.extend(boundary.first().copied());
    boundary
}
