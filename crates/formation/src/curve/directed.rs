//! A curve seen along a direction: points of attraction (6.3).
use super::piece::sagitta;
use super::primitive::Primitive;
use super::{Curve, Foot, Interval};
use nalgebra::Vector2;

/// Pieces are halved until their bulge is below this, m.
const FINE: f64 = 1e-11;
/// Ends of intervals that a line misses by less than this, m, are met.
const MISSED: f64 = 1e-9;

impl Curve {
    /// The least and the greatest component along the unit vector `axis`, m; infinite where an open end leads there.
    pub fn extent(&self, axis: Vector2<f64>) -> (f64, f64) {
        (-self.farthest_along(-axis).0, self.farthest_along(axis).0)
    }

    /// The points of attraction of a robot at `point` along `direction` (not zero): all points where the straight line through
    /// the robot meets the curve, or its open ends, by arc length.
    pub fn met_along(&self, point: Vector2<f64>, direction: Vector2<f64>) -> Vec<Foot> {
        let mut found: Vec<f64> = Vec::new();
        self.crossings(point, direction, &mut |arc_length| found.push(arc_length));
        found.sort_by(f64::total_cmp);
        found.dedup_by(|next, kept| *next - *kept < 1e-9);
        found.into_iter().map(|arc_length| self.seen_from(point, arc_length)).collect()
    }

    /// Of [`Self::met_along`] the one on `intervals` that is nearest to the robot: how far that is changes continuously with its place,
    /// whichever is next. Nothing where the line meets none of them.
    pub(super) fn first_met(
        &self,
        point: Vector2<f64>,
        direction: Vector2<f64>,
        intervals: &[Interval],
    ) -> Option<Foot> {
        let mut best: Option<Foot> = None;
        self.crossings(point, direction, &mut |arc_length| {
            if intervals.iter().any(|(from, to)| from - MISSED <= arc_length && arc_length <= to + MISSED) {
                let foot = self.seen_from(point, arc_length);
                if best.is_none_or(|best| foot.distance < best.distance) {
                    best = Some(foot);
                }
            }
        });
        best
    }

    /// Where the line through `point` along `direction` meets none of `intervals`: the end of one of them, the first or last point of the
    /// curve, or its outermost point, on one of them, that the line passes most closely. Nothing without intervals. An interval that goes on
    /// for ever has no end there: the line, which does not meet it, passes its extension most closely where that begins.
    pub(super) fn passed_most_closely(
        &self,
        point: Vector2<f64>,
        direction: Vector2<f64>,
        intervals: &[Interval],
    ) -> Option<Foot> {
        let across = Vector2::new(direction.y, -direction.x) / direction.norm();
        let on_one = |at: &f64| intervals.iter().any(|(from, to)| from <= at && at <= to);
        let outermost = [across, -across].into_iter().filter_map(|axis| self.farthest_along(axis).1).filter(on_one);
        // Where a closed curve begins nothing ends that goes on behind.
        let (joined, inside) = (self.joins(intervals), |at: &f64| 0.0 < *at && *at < self.length);
        let ends = intervals.iter().flat_map(|(from, to)| [*from, *to]).filter(|at| at.is_finite());
        let ends = ends.filter(|at| !joined || inside(at));
        let extended = [0.0, self.length].into_iter().filter(|_| self.open_start || self.open_end).filter(on_one);
        let passed = |foot: &Foot| (foot.point - point).dot(&across).abs();
        let feet = ends.chain(extended).chain(outermost).map(|arc_length| self.seen_from(point, arc_length));
        feet.min_by(|a, b| passed(a).total_cmp(&passed(b)))
    }

    fn seen_from(&self, point: Vector2<f64>, arc_length: f64) -> Foot {
        let foot = self.at(arc_length);
        Foot { distance: (foot.point - point).norm(), ..foot }
    }

    /// Tells the arc lengths of all points of attraction, in no order; those at joints may come twice.
    fn crossings(&self, point: Vector2<f64>, direction: Vector2<f64>, found: &mut impl FnMut(f64)) {
        let across = Vector2::new(direction.y, -direction.x) / direction.norm();
        let line = Line { point, across };
        for (index, piece) in self.pieces.iter().enumerate() {
            let primitive = &self.primitives[piece.primitive];
            line.crossings(primitive, (piece.from, piece.to), &mut |u| found(self.arc_length_at(index, u)));
        }
        for (is_open, last) in [(self.open_start, false), (self.open_end, true)] {
            let (end, tangent) = self.at_end(last);
            let outward = if last { tangent } else { -tangent };
            let beyond = -line.height(end) / outward.dot(&across);
            if is_open && beyond.is_finite() && beyond > 0.0 {
                found(if last { self.length + beyond } else { -beyond });
            }
        }
    }

    /// The greatest component along `axis` and the arc length of where it is, by halving only what may exceed the best so far; infinite
    /// and nowhere where an open end leads there.
    fn farthest_along(&self, axis: Vector2<f64>) -> (f64, Option<f64>) {
        let outward = [(self.open_start, -self.at_end(false).1), (self.open_end, self.at_end(true).1)];
        if outward.into_iter().any(|(is_open, tangent)| is_open && tangent.dot(&axis) > 0.0) {
            return (f64::INFINITY, None);
        }
        let mut best = (f64::NEG_INFINITY, 0, 0.0);
        let mut offer = |component: f64, index: usize, parameter: f64| {
            if component > best.0 {
                best = (component, index, parameter);
            }
            best.0
        };
        for (index, piece) in self.pieces.iter().enumerate() {
            offer(piece.start.dot(&axis), index, piece.from);
            offer(piece.end.dot(&axis), index, piece.to);
        }
        for (index, piece) in self.pieces.iter().enumerate() {
            let primitive = &self.primitives[piece.primitive];
            let mut stack = vec![(piece.from, piece.to)];
            while let Some((from, to)) = stack.pop() {
                let component = |u: f64| primitive.evaluate(u).point.dot(&axis);
                let (low, high) = (component(from), component(to));
                offer(low, index, from);
                let best = offer(high, index, to);
                let bulge = sagitta(primitive, from, to);
                if low.max(high) + bulge > best + FINE {
                    let middle = 0.5 * (from + to);
                    stack.extend([(middle, to), (from, middle)]);
                }
            }
        }
        (best.0, Some(self.arc_length_at(best.1, best.2)))
    }
}

/// A straight line through a point, by its unit normal.
struct Line {
    point: Vector2<f64>,
    across: Vector2<f64>,
}

impl Line {
    fn height(&self, at: Vector2<f64>) -> f64 {
        (at - self.point).dot(&self.across)
    }

    /// Tells the parameters at which a part of a primitive crosses the line.
    fn crossings(&self, primitive: &Primitive, (from, to): Interval, found: &mut impl FnMut(f64)) {
        let ends = (self.height(primitive.evaluate(from).point), self.height(primitive.evaluate(to).point));
        let (low, high) = (ends.0.min(ends.1), ends.0.max(ends.1));
        let bulge = sagitta(primitive, from, to);
        // An end of the curve may miss the line by rounding.
        if low > bulge.max(FINE) || high < -bulge.max(FINE) {
            return;
        }
        if bulge > FINE {
            let middle = 0.5 * (from + to);
            self.crossings(primitive, (from, middle), found);
            self.crossings(primitive, (middle, to), found);
        } else {
            let share = if ends.0 == ends.1 { 0.0 } else { (ends.0 / (ends.0 - ends.1)).clamp(0.0, 1.0) };
            found(from + share * (to - from));
        }
    }
}
