//! Distances of convex polygons that are rounded off by a radius.
use super::nearer::is_nearer;
use core::f64::consts::TAU;
use nalgebra::Vector2;

/// A convex polygon, corners counter-clockwise, grown by a radius: one point makes a disc, two a capsule. Borrowed, so
/// that no query allocates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outline<'a> {
    /// Corners, m; at least one.
    pub points: &'a [Vector2<f64>],
    /// Radius by which the polygon is grown, m.
    pub radius: f64,
}

/// How a point lies to an outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    /// Distance to the outline's boundary, m; negative inside.
    pub gap: f64,
    /// Unit vector from the point towards the outline: the direction in which the gap closes fastest.
    pub towards: Vector2<f64>,
}

/// What of a polygon is nearest to a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Feature {
    /// A corner, and those beside it, m.
    Corner { at: Vector2<f64>, neighbours: [Option<Vector2<f64>>; 2] },
    /// An edge: how far its ends are from where the point is abreast of it, m.
    Edge { before: f64, behind: f64 },
    /// The polygon holds the point.
    Inside,
}

impl Outline<'_> {
    /// What of the polygon itself is nearest to `point`.
    pub(crate) fn feature(&self, point: Vector2<f64>) -> Feature {
        if self.holds(point) {
            return Feature::Inside;
        }
        let (count, mut nearest) = (self.points.len(), (f64::INFINITY, 0, 0.0));
        for (index, (start, end)) in self.edges().enumerate() {
            let (edge, offset) = (end - start, point - start);
            let squared = edge.norm_squared();
            let fraction = if squared > 0.0 { (offset.dot(&edge) / squared).clamp(0.0, 1.0) } else { 0.0 };
            let away = (offset - fraction * edge).norm_squared();
            if away < nearest.0 {
                nearest = (away, index, fraction);
            }
        }
        let (_, index, fraction) = nearest;
        let next = (index + 1) % count;
        if 0.0 < fraction && fraction < 1.0 {
            let length = (self.points[next] - self.points[index]).norm();
            return Feature::Edge { before: fraction * length, behind: (1.0 - fraction) * length };
        }
        let corner = if fraction == 0.0 { index } else { next };
        let neighbour = |by: usize| (count > 1).then(|| self.points[(corner + by) % count]);
        Feature::Corner { at: self.points[corner], neighbours: [neighbour(1), neighbour(count - 1)] }
    }

    /// Distance and direction of the outline from `point`.
    pub fn approach(&self, point: Vector2<f64>) -> Approach {
        let mut nearest = Vector2::repeat(f64::INFINITY);
        let (mut depth, mut outward) = (f64::NEG_INFINITY, Vector2::x());
        for (start, end) in self.edges() {
            let (edge, offset) = (end - start, point - start);
            let squared = edge.norm_squared();
            let fraction = if squared > 0.0 { (offset.dot(&edge) / squared).clamp(0.0, 1.0) } else { 0.0 };
            let away = start + fraction * edge - point;
            if away.norm_squared() < nearest.norm_squared() {
                nearest = away;
            }
            let height = edge.perp(&offset) / -squared.sqrt();
            if height > depth {
                (depth, outward) = (height, Vector2::new(edge.y, -edge.x) / squared.sqrt());
            }
        }
        if self.points.len() > 2 && depth <= 0.0 {
            return Approach { gap: depth - self.radius, towards: -outward };
        }
        let distance = nearest.norm();
        let towards = if distance > 0.0 { nearest / distance } else { -outward };
        Approach { gap: distance - self.radius, towards }
    }

    /// Points along the boundary, m, for those who draw it: at each corner an arc of `steps` pieces between the normals of its edges, and
    /// the first point again at the end.
    pub fn boundary(&self, steps: usize) -> Vec<Vector2<f64>> {
        let corners = self.points;
        let normal = |edge: Vector2<f64>| libm::atan2(-edge.x, edge.y);
        let mut boundary = Vec::with_capacity(corners.len() * (steps + 1) + 1);
        for (index, corner) in corners.iter().enumerate() {
            let before = corners[(index + corners.len() - 1) % corners.len()];
            let after = corners[(index + 1) % corners.len()];
            let (from, mut to) =
                if corners.len() == 1 { (0.0, TAU) } else { (normal(corner - before), normal(after - corner)) };
            while to < from {
                to += TAU;
            }
            for step in 0..=steps {
                let (sine, cosine) = libm::sincos(from + (to - from) * step as f64 / steps as f64);
                boundary.push(corner + self.radius * Vector2::new(cosine, sine));
            }
        }
        boundary.extend(boundary.first().copied());
        boundary
    }

    /// Distance between two outlines, m; not positive if they overlap (then not their depth of penetration).
    pub fn gap(&self, other: &Outline<'_>) -> f64 {
        self.core_distance(other) - self.radius - other.radius
    }

    /// Whether the gap is strictly less than `limit` (m). Far cheaper than [`Self::gap`].
    pub fn is_nearer_than(&self, other: &Outline<'_>, limit: f64) -> bool {
        let limit = limit + self.radius + other.radius;
        // Points well inside both: between two corners that are opposite, or nearly.
        let inside = |points: &[Vector2<f64>]| 0.5 * (points[0] + points[points.len() / 2]);
        let arm = inside(other.points) - inside(self.points);
        is_nearer(self.points, other.points, arm, limit).unwrap_or_else(|| self.core_distance(other) < limit)
    }

    /// Centre and radius of a disc that holds it, m.
    pub fn disc_around(&self) -> (Vector2<f64>, f64) {
        let middle = self.middle();
        let farthest = self.points.iter().map(|point| (point - middle).norm_squared()).fold(0.0, f64::max);
        (middle, farthest.sqrt() + self.radius)
    }

    fn middle(&self) -> Vector2<f64> {
        self.points.iter().sum::<Vector2<f64>>() / self.points.len() as f64
    }

    /// Distance between the polygons themselves; zero if they overlap.
    fn core_distance(&self, other: &Outline<'_>) -> f64 {
        if self.holds(other.points[0]) || other.holds(self.points[0]) {
            return 0.0;
        }
        let mut least = f64::INFINITY;
        for (start, end) in self.edges() {
            for (other_start, other_end) in other.edges() {
                least = least.min(segment_gap_squared((start, end), (other_start, other_end)));
            }
        }
        least.sqrt()
    }

    /// Whether the polygon itself contains `point`.
    pub(super) fn holds(&self, point: Vector2<f64>) -> bool {
        self.points.len() > 2 && self.edges().all(|(start, end)| (end - start).perp(&(point - start)) >= 0.0)
    }

    /// Edges in order; a single point is an edge of length zero.
    pub(crate) fn edges(&self) -> impl Iterator<Item = (Vector2<f64>, Vector2<f64>)> + '_ {
        let count = if self.points.len() == 2 { 1 } else { self.points.len() };
        (0..count).map(|i| (self.points[i], self.points[(i + 1) % self.points.len()]))
    }
}

type Segment = (Vector2<f64>, Vector2<f64>);

/// Squared distance between two straight pieces; zero if they cross.
fn segment_gap_squared(a: Segment, b: Segment) -> f64 {
    let side = |line: Segment, point: Vector2<f64>| (line.1 - line.0).perp(&(point - line.0));
    if side(a, b.0) * side(a, b.1) < 0.0 && side(b, a.0) * side(b, a.1) < 0.0 {
        return 0.0;
    }
    let from = |point: Vector2<f64>, (start, end): Segment| {
        let edge = end - start;
        let squared = edge.norm_squared();
        let fraction = if squared > 0.0 { ((point - start).dot(&edge) / squared).clamp(0.0, 1.0) } else { 0.0 };
        (start + fraction * edge - point).norm_squared()
    };
    from(a.0, b).min(from(a.1, b)).min(from(b.0, a)).min(from(b.1, a))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_of_the_boundary_lies_on_it() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vector2::new(x, y));
        for (points, count) in [(&square[..], 69), (&square[..2], 35), (&square[..1], 18)] {
            let outline = Outline { points, radius: 0.1 };
            let boundary = outline.boundary(16);
            assert_eq!((boundary.len(), boundary[0]), (count, boundary[count - 1]));
            for point in boundary {
                assert!(outline.approach(point).gap.abs() < 1e-12, "{point}");
            }
        }
    }
}
