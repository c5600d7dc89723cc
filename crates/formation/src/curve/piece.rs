//! Short pieces of a curve over which it turns little: the table that every query starts from.
use super::{bend::Bend, error::CurveError, primitive::Primitive, quadrature::arc_length};
use nalgebra::Vector2;

/// Most a piece may turn, rad: within it arc length is close to linear in the parameter.
const MOST_TURN: f64 = 0.5;
const MOST_SPLITS: u32 = 40;

/// Part of a primitive, with what is needed to bound its distance from a point.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Piece {
    /// Index of the primitive.
    pub(super) primitive: usize,
    /// Parameter interval.
    pub(super) from: f64,
    pub(super) to: f64,
    /// Arc length of the curve at `from`, and of the piece, metres.
    pub(super) offset: f64,
    pub(super) length: f64,
    /// End points, and how far the piece may lie from the chord between them.
    pub(super) start: Vector2<f64>,
    pub(super) end: Vector2<f64>,
    pub(super) sagitta: f64,
    /// What is known of it besides, unless it is straight or part of a circle.
    pub(super) bend: Option<Box<Bend>>,
}

impl Piece {
    /// Arc length from its start to a parameter, m.
    #[inline]
    pub(super) fn length_to(&self, primitive: &Primitive, parameter: f64) -> f64 {
        let known = self.bend.as_ref().and_then(|bend| bend.length_to(parameter));
        known.unwrap_or_else(|| arc_length(primitive, self.from, parameter))
    }

    /// How far from its start (or `end`) points may be, m, for nothing of the piece to be nearer to them than that joint, if they lie
    /// before (or after) it: if (J - q).T >= 0 with J the joint and T the tangent there into the piece. With S the bound of |p''|,
    /// p(u) - J goes at least m u along T and at most S u^2 / 2 across it, m = |p'(J)| - S w / 2 over the width w. So
    /// |p(u) - q|^2 >= |J - q|^2 + m^2 u^2 - |q - J| S u^2.
    pub(super) fn shields(&self, primitive: &Primitive, end: bool) -> f64 {
        let width = self.to - self.from;
        let (second, _) = primitive.derivative_bounds(0.5 * (self.from + self.to), 0.5 * width);
        let speed = primitive.evaluate(if end { self.to } else { self.from }).first.norm();
        let least = (speed - 0.5 * second * width).max(0.0);
        if second > 0.0 { least * least / second } else { f64::INFINITY }
    }

    /// Squared distance of its chord from `point`, m^2: its sagitta tells how much nearer the piece may be.
    #[inline]
    pub(super) fn chord_distance_squared(&self, point: Vector2<f64>) -> f64 {
        let (chord, offset) = (self.end - self.start, point - self.start);
        let squared = chord.norm_squared();
        let fraction = if squared > 0.0 { (offset.dot(&chord) / squared).clamp(0.0, 1.0) } else { 0.0 };
        (offset - fraction * chord).norm_squared()
    }
}

/// Cuts `primitive` over [from, to] into pieces, appended to `pieces` from arc length `offset` on; returns the arc
/// length at the end.
pub(super) fn cut(
    primitive: &Primitive,
    index: usize,
    (from, to): (f64, f64),
    offset: f64,
    pieces: &mut Vec<Piece>,
) -> Result<f64, CurveError> {
    let mut stack = vec![(from, to, 0)];
    let mut reached = offset;
    while let Some((from, to, depth)) = stack.pop() {
        let length = arc_length(primitive, from, to);
        if turns_little(primitive, from, to) && quadrature_converged(primitive, from, to, length) {
            let sagitta = sagitta(primitive, from, to);
            let (start, end) = (primitive.evaluate(from).point, primitive.evaluate(to).point);
            let bend = Bend::of(primitive, from, to, length);
            pieces.push(Piece { primitive: index, from, to, offset: reached, length, start, end, sagitta, bend });
            reached += length;
        } else if depth == MOST_SPLITS {
            return Err(CurveError::Cusp { arc_length: reached });
        } else {
            let middle = 0.5 * (from + to);
            stack.push((middle, to, depth + 1));
            stack.push((from, middle, depth + 1));
        }
    }
    Ok(reached)
}

/// Whether the tangent turns by at most [`MOST_TURN`]: |p''| h over the least speed bounds the angle.
fn turns_little(primitive: &Primitive, from: f64, to: f64) -> bool {
    let (middle, width) = (0.5 * (from + to), to - from);
    let (second, _) = primitive.derivative_bounds(middle, 0.5 * width);
    let least_speed = primitive.evaluate(middle).first.norm() - 0.5 * width * second;
    least_speed > 0.0 && second * width <= MOST_TURN * least_speed
}

fn quadrature_converged(primitive: &Primitive, from: f64, to: f64, length: f64) -> bool {
    let middle = 0.5 * (from + to);
    let halves = arc_length(primitive, from, middle) + arc_length(primitive, middle, to);
    (halves - length).abs() <= 1e-13 * length
}

/// Bound of the distance between a primitive over [from, to] and its chord: max|p''| h^2 / 8.
pub(super) fn sagitta(primitive: &Primitive, from: f64, to: f64) -> f64 {
    let width = to - from;
    let (second, _) = primitive.derivative_bounds(0.5 * (from + to), 0.5 * width);
    0.125 * width * width * second
}

/// Distance from `point` to the straight piece between `start` and `end`, and the nearest point's fraction of it.
pub(super) fn distance_to_chord(point: Vector2<f64>, start: Vector2<f64>, end: Vector2<f64>) -> (f64, f64) {
    let chord = end - start;
    let squared = chord.norm_squared();
    let fraction = if squared > 0.0 { ((point - start).dot(&chord) / squared).clamp(0.0, 1.0) } else { 0.0 };
    ((start + fraction * chord - point).norm(), fraction)
}
