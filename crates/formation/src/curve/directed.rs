//! A curve seen along a direction: points of attraction (6.3).
use super::piece::{Piece, sagitta};
use super::{Curve, Foot};
use nalgebra::Vector2;

/// Pieces are halved until their bulge is below this, m.
const FINE: f64 = 1e-11;

impl Curve {
    /// The least and the greatest component along the unit vector `axis`, m; infinite where an open end leads there.
    pub fn extent(&self, axis: Vector2<f64>) -> (f64, f64) {
        (-self.reach(-axis), self.reach(axis))
    }

    /// The points of attraction of a robot at `point` along `direction` (not zero): all points where the straight line through
    /// the robot meets the curve, or its open ends, by arc length. The thesis takes the one ahead of the robot.
    pub fn met_along(&self, point: Vector2<f64>, direction: Vector2<f64>) -> Vec<Foot> {
        let across = Vector2::new(direction.y, -direction.x) / direction.norm();
        let height = |at: Vector2<f64>| (at - point).dot(&across);
        let mut found: Vec<f64> = Vec::new();
        for (index, piece) in self.pieces.iter().enumerate() {
            let primitive = &self.primitives[piece.primitive];
            let mut stack = vec![(piece.from, piece.to)];
            while let Some((from, to)) = stack.pop() {
                let ends = (height(primitive.evaluate(from).point), height(primitive.evaluate(to).point));
                let (low, high) = (ends.0.min(ends.1), ends.0.max(ends.1));
                let bulge = sagitta(primitive, from, to);
                if low > bulge || high < -bulge {
                    continue;
                }
                if bulge > FINE {
                    let middle = 0.5 * (from + to);
                    stack.extend([(middle, to), (from, middle)]);
                    continue;
                }
                // An end of the curve may miss the line by rounding.
                if low <= FINE && high >= -FINE {
                    let share = if ends.0 == ends.1 { 0.0 } else { (ends.0 / (ends.0 - ends.1)).clamp(0.0, 1.0) };
                    found.push(self.arc_length_at(index, from + share * (to - from)));
                }
            }
        }
        for (is_open, last) in [(self.open_start, false), (self.open_end, true)] {
            let (end, tangent) = self.at_end(last);
            let outward = if last { tangent } else { -tangent };
            let beyond = -height(end) / outward.dot(&across);
            if is_open && beyond.is_finite() && beyond > 0.0 {
                found.push(if last { self.length + beyond } else { -beyond });
            }
        }
        found.sort_by(f64::total_cmp);
        found.dedup_by(|next, kept| *next - *kept < 1e-9);
        let foot = |at: f64| Foot { distance: (self.at(at).point - point).norm(), ..self.at(at) };
        found.into_iter().map(foot).collect()
    }

    /// The greatest component along `axis`, by halving only what may exceed the best so far.
    fn reach(&self, axis: Vector2<f64>) -> f64 {
        let outward = [(self.open_start, -self.at_end(false).1), (self.open_end, self.at_end(true).1)];
        if outward.into_iter().any(|(is_open, tangent)| is_open && tangent.dot(&axis) > 0.0) {
            return f64::INFINITY;
        }
        let ends = |piece: &Piece| piece.start.dot(&axis).max(piece.end.dot(&axis));
        let mut best = self.pieces.iter().map(ends).fold(f64::NEG_INFINITY, f64::max);
        for piece in &self.pieces {
            let primitive = &self.primitives[piece.primitive];
            let mut stack = vec![(piece.from, piece.to)];
            while let Some((from, to)) = stack.pop() {
                let component = |u: f64| primitive.evaluate(u).point.dot(&axis);
                let (low, high) = (component(from), component(to));
                best = best.max(low).max(high);
                let bulge = sagitta(primitive, from, to);
                if low.max(high) + bulge > best + FINE {
                    let middle = 0.5 * (from + to);
                    stack.extend([(middle, to), (from, middle)]);
                }
            }
        }
        best
    }
}
