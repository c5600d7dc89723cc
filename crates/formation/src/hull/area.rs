//! Repulsive areas around an apparent obstacle (7.4.3, Fig. 7.9).
use super::Outline;
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
