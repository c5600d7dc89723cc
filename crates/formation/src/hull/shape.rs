//! Apparent obstacles of single obstacles: convex hulls (7.6).
use super::{HullError, Outline, convex::convex_hull};
use core::f64::consts::PI;
use nalgebra::Vector2;

/// A convex polygon grown by a radius; owned, valid by construction.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    points: Vec<Vector2<f64>>,
    radius: f64,
    /// A disc that holds it: for most questions about what is far away that is enough.
    middle: Vector2<f64>,
    extent: f64,
}

impl Shape {
    /// Convex hull of an obstacle: a disc (one point), a wall (two) or a simple polygon, grown by `radius` (m).
    ///
    /// # Errors
    /// [`HullError`] for no points, numbers that are not finite, a negative radius, polygons without area or that cross
    /// themselves.
    pub fn new(points: &[Vector2<f64>], radius: f64) -> Result<Self, HullError> {
        let hull = Self::enclosing(points, radius)?;
        if points.len() >= 3 && hull.points.len() < 3 {
            return Err(HullError::NoArea);
        }
        simple(points)?;
        Ok(hull)
    }

    /// Convex hull of any points, of a polygon that is none too, grown by `radius` (m).
    ///
    /// # Errors
    /// [`HullError`] for no points, numbers that are not finite and a negative radius.
    pub fn enclosing(points: &[Vector2<f64>], radius: f64) -> Result<Self, HullError> {
        if points.is_empty() {
            return Err(HullError::NoPoints);
        }
        if let Some(corner) = points.iter().position(|point| !(point.x.is_finite() && point.y.is_finite())) {
            return Err(HullError::NotFinite(corner));
        }
        let radius = length("the radius", radius)?;
        let mut points = points.to_vec();
        convex_hull(&mut points);
        Ok(Self::of_hull(points, radius))
    }

    /// Hull of several shapes, which must not be empty. It is grown by the least of their radii; rounder corners become
    /// circumscribed polygons, so that the hull contains the exact one and exceeds it by less than 0.5 % of the
    /// difference of the radii.
    pub(crate) fn around<'a>(shapes: impl Iterator<Item = &'a Self> + Clone) -> Self {
        let radius = shapes.clone().map(|shape| shape.radius).fold(f64::INFINITY, f64::min);
        let mut points = Vec::new();
        for shape in shapes {
            if shape.radius == radius {
                points.extend_from_slice(&shape.points);
            } else {
                let arms = circumscribed(shape.radius - radius);
                points.extend(shape.points.iter().flat_map(|point| arms.map(|arm| point + arm)));
            }
        }
        convex_hull(&mut points);
        Self::of_hull(points, radius)
    }

    /// `points` are the corners of a convex polygon.
    fn of_hull(points: Vec<Vector2<f64>>, radius: f64) -> Self {
        let (middle, extent) = Outline { points: &points, radius }.disc_around();
        // More than rounding may take.
        Self { points, radius, middle, extent: extent * (1.0 + 1e-9) }
    }

    /// Whether it is farther than `distance` (m) from `point` for certain, and then [`Outline::approach`] would say so; quickly found,
    /// but not of all shapes that are.
    #[inline]
    pub fn is_beyond(&self, point: Vector2<f64>, distance: f64) -> bool {
        let far = distance + self.extent;
        (point - self.middle).norm_squared() > far * far
    }

    /// A bound of the gap that [`Outline::approach`] would say, from below, m; quickly found.
    pub fn least_gap(&self, point: Vector2<f64>) -> f64 {
        (point - self.middle).norm() - self.extent
    }

    /// The shape displaced by `by` (m).
    ///
    /// # Errors
    /// A displacement that is not finite.
    pub fn moved(&self, by: Vector2<f64>) -> Result<Self, HullError> {
        let points: Vec<Vector2<f64>> = self.points.iter().map(|point| point + by).collect();
        match points.iter().position(|point| !(point.x.is_finite() && point.y.is_finite())) {
            Some(corner) => Err(HullError::NotFinite(corner)),
            None => Ok(Self::of_hull(points, self.radius)),
        }
    }

    /// A point well inside, about which it lies, m.
    pub(crate) fn middle(&self) -> Vector2<f64> {
        self.middle
    }

    /// Corners counter-clockwise and radius.
    #[inline]
    pub fn outline(&self) -> Outline<'_> {
        Outline { points: &self.points, radius: self.radius }
    }

    /// Its least extent over all directions, m: that of the narrowest gap it passes.
    pub fn width(&self) -> f64 {
        let across = |(start, end): (Vector2<f64>, Vector2<f64>)| {
            let edge = (end - start).try_normalize(0.0)?;
            let heights = self.points.iter().map(|point| edge.perp(&(point - start)).abs());
            Some(heights.fold(0.0, f64::max))
        };
        let least = self.outline().edges().filter_map(across).fold(f64::INFINITY, f64::min);
        2.0 * self.radius + if least.is_finite() { least } else { 0.0 }
    }

    /// Area with the rounding, m^2.
    pub fn area(&self) -> f64 {
        let next = self.points.iter().cycle().skip(1);
        let (mut doubled, mut perimeter) = (0.0, 0.0);
        for (start, end) in self.points.iter().zip(next) {
            doubled += start.perp(end);
            perimeter += (end - start).norm();
        }
        0.5 * doubled + perimeter * self.radius + PI * self.radius * self.radius
    }
}

/// `value` if it can be a length.
pub(super) fn length(what: &'static str, value: f64) -> Result<f64, HullError> {
    if value.is_finite() && value >= 0.0 { Ok(value) } else { Err(HullError::Negative { what, value }) }
}

/// Corners of a regular polygon about a circle.
fn circumscribed(radius: f64) -> [Vector2<f64>; 32] {
    let half = PI / 32.0;
    let reach = radius / libm::cos(half);
    core::array::from_fn(|i| {
        let (sine, cosine) = libm::sincos(2.0 * half * i as f64);
        Vector2::new(reach * cosine, reach * sine)
    })
}

/// Error if two edges of a polygon meet elsewhere than at the corner between neighbours.
fn simple(points: &[Vector2<f64>]) -> Result<(), HullError> {
    let count = points.len();
    if count < 4 {
        return Ok(());
    }
    let edge = |i: usize| [points[i], points[(i + 1) % count]];
    let gap = |a: [Vector2<f64>; 2], b: [Vector2<f64>; 2]| {
        let [a, b] = [&a, &b].map(|points| Outline { points, radius: 0.0 });
        a.gap(&b)
    };
    // Most pairs of edges are not even near each other.
    let boxes: Vec<[Vector2<f64>; 2]> =
        (0..count).map(edge).map(|[start, end]| [start.inf(&end), start.sup(&end)]).collect();
    let apart = |a: usize, b: usize| {
        let ([a_low, a_high], [b_low, b_high]) = (boxes[a], boxes[b]);
        a_low.x > b_high.x || b_low.x > a_high.x || a_low.y > b_high.y || b_low.y > a_high.y
    };
    for i in 0..count {
        for j in i + 2..count {
            let neighbours = i == 0 && j == count - 1;
            if !neighbours && !apart(i, j) && gap(edge(i), edge(j)) <= 0.0 {
                return Err(HullError::SelfCrossing(i, j));
            }
        }
    }
    Ok(())
}
