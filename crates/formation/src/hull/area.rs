//! Repulsive areas around an apparent obstacle (7.4.3, Fig. 7.9).
use super::Outline;
use core::f64::consts::TAU;
use nalgebra::Vector2;

/// Which part of an outline is nearest, and so in which direction it repels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RepulsiveArea {
    /// In the polygon itself: out through its nearest face.
    Inside,
    /// The rectangle before the face from this corner to the next: always across the face.
    Face(usize),
    /// The sector at this corner: away from the corner.
    Corner(usize),
}

impl Outline<'_> {
    /// The repulsive area that holds `point`. Areas do not overlap, as the outline is convex (Proposition 7.4.1).
    pub fn repulsive_area(&self, point: Vector2<f64>) -> RepulsiveArea {
        if self.holds(point) {
            return RepulsiveArea::Inside;
        }
        let count = self.points.len();
        let mut nearest = (f64::INFINITY, RepulsiveArea::Corner(0));
        for (index, (start, end)) in self.edges().enumerate() {
            let (edge, offset) = (end - start, point - start);
            let (along, squared) = (offset.dot(&edge), edge.norm_squared());
            let (area, away) = if along <= 0.0 {
                (RepulsiveArea::Corner(index), offset)
            } else if along >= squared {
                (RepulsiveArea::Corner((index + 1) % count), point - end)
            } else {
                (RepulsiveArea::Face(index), offset - edge * (along / squared))
            };
            if away.norm_squared() < nearest.0 {
                nearest = (away.norm_squared(), area);
            }
        }
        nearest.1
    }

    /// The edges of all repulsive areas out to `reach` (m) from the outline, m, for those who draw them: before each face a rectangle, at
    /// each corner a sector whose arcs have `steps` pieces. The last point of each is its first.
    pub fn repulsive_areas(&self, reach: f64, steps: usize) -> Vec<Vec<Vector2<f64>>> {
        let count = self.points.len();
        let corner = |index: usize| self.points[index % count];
        let outward = |edge: Vector2<f64>| Vector2::new(edge.y, -edge.x) / edge.norm();
        let (near, far) = (self.radius, self.radius + reach);
        let mut areas = Vec::with_capacity(2 * count);
        for index in 0..count {
            let (before, here, after) = (corner(index + count - 1), corner(index), corner(index + 1));
            let (mut from, mut to) = (0.0, TAU);
            if count > 1 {
                let [first, second] = [here - before, after - here].map(outward);
                areas.push(
                    [(here, near), (here, far), (after, far), (after, near), (here, near)]
                        .map(|(at, by)| at + by * second)
                        .to_vec(),
                );
                (from, to) = (libm::atan2(first.y, first.x), libm::atan2(second.y, second.x));
                if to < from {
                    to += TAU;
                }
            }
            let at = |step: usize, radius: f64| {
                let (sine, cosine) = libm::sincos(from + (to - from) * step as f64 / steps as f64);
                here + radius * Vector2::new(cosine, sine)
            };
            let (out, back) = ((0..=steps).map(|step| at(step, near)), (0..=steps).rev().map(|step| at(step, far)));
            areas.push(out.chain(back).chain([at(0, near)]).collect());
        }
        areas
    }

    /// The corners at both ends of a face.
    pub fn face(&self, index: usize) -> (Vector2<f64>, Vector2<f64>) {
        (self.points[index % self.points.len()], self.points[(index + 1) % self.points.len()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(point: [f64; 2], expected: RepulsiveArea, towards: [f64; 2]) {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(Vector2::from);
        let outline = Outline { points: &square, radius: 0.25 };
        assert_eq!(outline.repulsive_area(point.into()), expected, "{point:?}");
        assert!((outline.approach(point.into()).towards - Vector2::from(towards)).norm() < 1e-12, "{point:?}");
    }

    #[test]
    fn faces_and_corners_of_fig_7_9() {
        check([1.0, -1.0], RepulsiveArea::Face(0), [0.0, 1.0]);
        check([1.9, -3.0], RepulsiveArea::Face(0), [0.0, 1.0]);
        check([3.0, 0.5], RepulsiveArea::Face(1), [-1.0, 0.0]);
        check([2.6, -0.8], RepulsiveArea::Corner(1), [-0.6, 0.8]);
        check([-3.0, -4.0], RepulsiveArea::Corner(0), [0.6, 0.8]);
        check([1.9, 1.0], RepulsiveArea::Inside, [-1.0, 0.0]);
    }

    /// They fill what is within reach, each is one area, and none lies in another.
    #[test]
    fn areas_are_drawn_where_they_are() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(Vector2::from);
        let surface =
            |area: &Vec<Vector2<f64>>| 0.5 * area.windows(2).map(|pair| pair[0].perp(&pair[1])).sum::<f64>().abs();
        let disc = |radius: f64| core::f64::consts::PI * radius * radius;
        // Of a wall both sides and both ends, of a disc the ring.
        for (count, length, areas) in [(4, 8.0, 8), (2, 4.0, 4), (1, 0.0, 1)] {
            let outline = Outline { points: &square[..count], radius: 0.25 };
            let drawn = outline.repulsive_areas(0.5, 256);
            assert_eq!(drawn.len(), areas);
            let (all, whole) = (drawn.iter().map(surface).sum::<f64>(), 0.5 * length + disc(0.75) - disc(0.25));
            assert!((all / whole - 1.0).abs() < 1e-3, "{count} corners: {all} of {whole}");
            for area in &drawn {
                assert_eq!(area[0], area[area.len() - 1]);
                assert!(area.iter().all(|point| (-1e-12..0.5 + 1e-12).contains(&outline.approach(*point).gap)));
            }
        }
        let outline = Outline { points: &square, radius: 0.25 };
        let within = |area: &[Vector2<f64>]| {
            outline.repulsive_area(area[..area.len() - 1].iter().sum::<Vector2<f64>>() / (area.len() - 1) as f64)
        };
        let drawn = outline.repulsive_areas(0.5, 2);
        for (index, pair) in drawn.chunks(2).enumerate() {
            assert_eq!(
                [within(&pair[0]), within(&pair[1])],
                [RepulsiveArea::Face(index), RepulsiveArea::Corner(index)]
            );
        }
    }

    #[test]
    fn discs_and_walls() {
        let wall = [[0.0, 0.0], [2.0, 0.0]].map(Vector2::from);
        let disc = Outline { points: &wall[..1], radius: 1.0 };
        let wall = Outline { points: &wall, radius: 0.0 };
        assert_eq!(disc.repulsive_area(Vector2::new(5.0, 1.0)), RepulsiveArea::Corner(0));
        assert_eq!(wall.repulsive_area(Vector2::new(1.0, -1.0)), RepulsiveArea::Face(0));
        assert_eq!(wall.repulsive_area(Vector2::new(3.0, -1.0)), RepulsiveArea::Corner(1));
    }
}
