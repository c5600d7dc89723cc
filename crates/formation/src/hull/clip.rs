//! The part of a convex shape that is in a square.
use super::Shape;
use nalgebra::Vector2;

impl Shape {
    /// What of it is in the square of half side `half` (m) about `middle`, and by its radius beyond; nothing if it is all outside.
    pub(crate) fn within(&self, middle: Vector2<f64>, half: f64) -> Option<Self> {
        let outline = self.outline();
        let reach = half + outline.radius;
        let mut points = outline.points.to_vec();
        for axis in 0..2 {
            for side in [-1.0, 1.0] {
                points = clipped(&points, |point| reach - side * (point[axis] - middle[axis]));
            }
        }
        Self::enclosing(&points, outline.radius).ok()
    }
}

/// The corners of a convex polygon (a point, a line) where `inside`, which is linear, is not negative (Sutherland and Hodgman).
fn clipped(points: &[Vector2<f64>], inside: impl Fn(&Vector2<f64>) -> f64) -> Vec<Vector2<f64>> {
    let mut kept = Vec::with_capacity(points.len() + 2);
    for (start, end) in points.iter().zip(points.iter().cycle().skip(1)) {
        let (here, there) = (inside(start), inside(end));
        if here >= 0.0 {
            kept.push(*start);
        }
        if (here < 0.0) != (there < 0.0) {
            kept.push(start + here / (here - there) * (end - start));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(points: &[(f64, f64)], radius: f64, half: f64) -> Option<Vec<(f64, f64)>> {
        let points: Vec<Vector2<f64>> = points.iter().map(|(x, y)| Vector2::new(*x, *y)).collect();
        let part = Shape::new(&points, radius).unwrap().within(Vector2::zeros(), half)?;
        let mut corners: Vec<(f64, f64)> = part.outline().points.iter().map(|point| (point.x, point.y)).collect();
        corners.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        Some(corners)
    }

    #[test]
    fn polygons_lines_and_points_are_cut_to_the_square() {
        assert_eq!(corners(&[(-9.0, -1.0), (9.0, -1.0)], 0.0, 2.0), Some(vec![(-2.0, -1.0), (2.0, -1.0)]));
        let triangle = corners(&[(-2.0, -2.0), (6.0, -2.0), (-2.0, 6.0)], 0.0, 3.0);
        assert_eq!(triangle, Some(vec![(-2.0, -2.0), (-2.0, 3.0), (1.0, 3.0), (3.0, -2.0), (3.0, 1.0)]));
        assert_eq!(corners(&[(1.0, 1.0)], 0.3, 2.0), Some(vec![(1.0, 1.0)]));
        assert_eq!(corners(&[(5.0, 5.0), (6.0, 5.0), (5.0, 6.0)], 0.5, 2.0), None);
    }

    #[test]
    fn what_reaches_into_the_square_by_its_radius_counts() {
        assert_eq!(corners(&[(-8.0, 2.25), (8.0, 2.25)], 0.5, 2.0), Some(vec![(-2.5, 2.25), (2.5, 2.25)]));
        assert_eq!(corners(&[(-8.0, 2.75), (8.0, 2.75)], 0.5, 2.0), None);
    }
}
