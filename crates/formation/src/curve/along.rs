//! Ways along a curve.
use super::Curve;

/// Just ahead of an arc length, of the curve's length.
const AHEAD: f64 = 1e-9;

impl Curve {
    /// How far it is along the curve from one arc length to another (m), with its sign; round a closed curve the shorter way.
    pub fn way(&self, from: f64, to: f64) -> f64 {
        if self.closed { self.next_to(from, to) - from } else { to - from }
    }

    /// The arc length just ahead of one (m) on a way as long as `left` (m, with its sign). The tangent there leads on where the point before is a
    /// corner, which is nearest to all in a wedge: there a robot that went along the tangent of the piece behind would leave the curve.
    pub fn ahead(&self, arc_length: f64, left: f64) -> f64 {
        arc_length + left.abs().min(AHEAD * self.length).copysign(left)
    }
}

#[cfg(test)]
mod tests {
    use crate::Vector2;
    use crate::curve::{Curve, CurveShape};

    #[test]
    fn round_a_closed_curve_it_is_the_shorter_way() {
        let points = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0], [0.0, 0.0]].map(Vector2::from).to_vec();
        let closed = Curve::new(&CurveShape::Polyline(points.clone()), false, false).unwrap();
        assert!(closed.is_closed());
        let ways = [closed.way(9.0, 1.0), closed.way(1.0, 9.0), closed.way(1.0, 4.0)];
        assert_eq!(ways, [2.0, -2.0, 3.0]);
        let open = Curve::new(&CurveShape::Polyline(points[..4].to_vec()), false, false).unwrap();
        assert_eq!(open.way(7.0, 1.0), -6.0);
    }

    #[test]
    fn ahead_of_a_corner_is_the_next_piece() {
        let points = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0]].map(Vector2::from).to_vec();
        let curve = Curve::new(&CurveShape::Polyline(points), false, false).unwrap();
        let corner = curve.nearest(Vector2::new(4.0, -1.0));
        let tangent = |left: f64| curve.at(curve.ahead(corner.arc_length, left)).tangent;
        assert_eq!([tangent(1.0), tangent(-1.0)], [Vector2::y(), Vector2::x()]);
        assert_eq!(curve.ahead(3.0, 0.0), 3.0);
    }
}
