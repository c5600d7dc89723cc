//! Short pieces of a curve over which it turns little: the table that every query starts from.
use super::{bend::Bend, error::CurveError, primitive::Primitive, quadrature::arc_length};
use nalgebra::Vector2;

/// Most a piece may turn, rad: within it arc length is close to linear in the parameter.
const MOST_TURN: f64 = 0.5;
const MOST_SPLITS: u32 = 40;
/// Lengths of a piece and of its halves that differ by no more than this share of it agree.
const AGREEMENT: f64 = 1e-13;
/// Where halving no longer brings them nearer, what is left is rounding of the function, as long as it is no more than this share.
const ROUNDING: f64 = 1e-9;
/// Halving brings them nearer by much more than this factor, unless that is rounding.
const NEARER: f64 = 4.0;
/// A curve of more pieces is no segment for robots: already to build it would take minutes.
pub(super) const MOST_PIECES: usize = 100_000;
/// Coordinates and lengths above this (m) are no sizes, and leave no digits for millimetres.
pub(super) const LARGEST: f64 = 1e12;

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

/// A straight line, start + u direction, the tangent on it, and the curvature: a zero, of the sign that other primitives would give it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Straight {
    start: Vector2<f64>,
    direction: Vector2<f64>,
    pub(super) tangent: Vector2<f64>,
    pub(super) curvature: f64,
}

impl Straight {
    pub(super) fn of(primitive: &Primitive) -> Option<Self> {
        let Primitive::Line { start, direction } = *primitive else { return None };
        let jet = primitive.evaluate(0.0);
        Some(Self { start, direction, tangent: direction / direction.norm(), curvature: jet.first.perp(&jet.second) })
    }

    /// The parameter of the foot of the perpendicular.
    #[inline]
    pub(super) fn nearest(&self, point: Vector2<f64>) -> f64 {
        (point - self.start).dot(&self.direction)
    }

    #[inline]
    pub(super) fn at(&self, parameter: f64) -> Vector2<f64> {
        self.start + parameter * self.direction
    }
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
    let mut stack = vec![(from, to, 0, f64::INFINITY)];
    let mut reached = offset;
    while let Some((from, to, depth, known)) = stack.pop() {
        let length = arc_length(primitive, from, to);
        let disagreement = match turns_little(primitive, from, to) {
            true => disagreement(primitive, from, to, length),
            false => f64::INFINITY,
        };
        let is_rounding = disagreement <= ROUNDING && disagreement * NEARER >= known;
        if disagreement <= agreement(from, to) || is_rounding {
            let sagitta = sagitta(primitive, from, to);
            let (start, end) = (primitive.evaluate(from).point, primitive.evaluate(to).point);
            let bend = Bend::of(primitive, from, to, length);
            pieces.push(Piece { primitive: index, from, to, offset: reached, length, start, end, sagitta, bend });
            reached += length;
        } else if pieces.len() + stack.len() >= MOST_PIECES {
            return Err(CurveError::ManyPieces { arc_length: reached });
        } else if depth == MOST_SPLITS {
            let (what, value) = ("the slope of the curve", primitive.evaluate(from).first.amax());
            let too_steep = value.is_nan() || value > LARGEST;
            return Err(if too_steep {
                CurveError::Size { what, value }
            } else {
                CurveError::Cusp { arc_length: reached }
            });
        } else {
            let middle = 0.5 * (from + to);
            stack.push((middle, to, depth + 1, disagreement));
            stack.push((from, middle, depth + 1, disagreement));
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

/// By which share of it the lengths of a piece and of its halves may differ: the more the rounding of its parameter is against its width.
/// The speed changes over a piece by less than itself, so that a parameter which is off by a share of the width is no more for the length.
fn agreement(from: f64, to: f64) -> f64 {
    AGREEMENT.max(4.0 * f64::EPSILON * from.abs().max(to.abs()) / (to - from))
}

/// By which share of it the length of a piece differs from that of its halves.
fn disagreement(primitive: &Primitive, from: f64, to: f64, length: f64) -> f64 {
    let middle = 0.5 * (from + to);
    let halves = arc_length(primitive, from, middle) + arc_length(primitive, middle, to);
    (halves - length).abs() / length
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
