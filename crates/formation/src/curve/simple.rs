//! Whether a curve meets itself.
use super::piece::{Piece, distance_to_chord, sagitta};
use super::primitive::Primitive;
use super::quadrature::arc_length;
use super::{Curve, error::CurveError};
use nalgebra::Vector2;

/// Passages nearer than this part of the curve's length count as a meeting.
pub(super) const TOUCH: f64 = 1e-9;
/// Passages that are no farther from each other along the curve than so many times that do not: between them there is no room to come back.
const BESIDE: f64 = 4.0;

/// Error if the curve meets itself or turns back on itself. A smooth piece turns by at most 0.5 rad, so neither one
/// piece nor two neighbours without a sharp corner between them can meet themselves.
pub(super) fn check(curve: &Curve) -> Result<(), CurveError> {
    if let [only] = curve.primitives.as_slice()
        && only.is_graph()
    {
        return Ok(());
    }
    let last = curve.pieces.len() - 1;
    for joint in 0..=last {
        corner(curve, joint)?;
    }
    for (i, j) in curve.tree.meeting_pairs() {
        let neighbours = j == i + 1 || (curve.closed && i == 0 && j == last);
        let (a, b) = (&curve.pieces[i], &curve.pieces[j]);
        let [on_a, on_b] = [a, b].map(|piece| &curve.primitives[piece.primitive]);
        let as_graph = a.primitive == b.primitive && on_a.is_graph();
        let counts = |first: f64, second: f64| !curve.is_beside(first, second);
        if !neighbours
            && !as_graph
            && let Some((first, second)) = meeting(curve.length, (on_a, a), (on_b, b), counts)
        {
            return Err(CurveError::SelfIntersection { first, second });
        }
    }
    Ok(())
}

impl Curve {
    /// Whether two places are so near to each other along the curve that they need not be apart.
    pub(super) fn is_beside(&self, first: f64, second: f64) -> bool {
        let between = (second - first).abs();
        let between = if self.closed { between.min(self.length - between) } else { between };
        between <= BESIDE * TOUCH * self.length
    }
}

/// Error if the tangent turns by nearly pi at the start of piece `joint`.
fn corner(curve: &Curve, joint: usize) -> Result<(), CurveError> {
    let Some((before, after)) = curve.tangents_at_joint(joint) else { return Ok(()) };
    let straight = curve.pieces[joint].sagitta == 0.0 && curve.pieces[curve.piece_before(joint)].sagitta == 0.0;
    let sharpest = if straight { -1.0 + 1e-12 } else { -0.5 };
    let arc_length = curve.pieces[joint].offset;
    if before.dot(&after) < sharpest { Err(CurveError::Cusp { arc_length }) } else { Ok(()) }
}

/// Arc lengths at which two pieces of a curve of this `length` (m) meet, if that counts, by halving the more curved one until chords decide.
pub(super) fn meeting(
    length: f64,
    (on_a, a): (&Primitive, &Piece),
    (on_b, b): (&Primitive, &Piece),
    counts: impl Fn(f64, f64) -> bool,
) -> Option<(f64, f64)> {
    let touch = TOUCH * length;
    let mut stack = vec![((a.from, a.to), (b.from, b.to))];
    while let Some((part_a, part_b)) = stack.pop() {
        let (bulge_a, bulge_b) = (sagitta(on_a, part_a.0, part_a.1), sagitta(on_b, part_b.0, part_b.1));
        let ends =
            |u: (f64, f64), primitive: &Primitive| (primitive.evaluate(u.0).point, primitive.evaluate(u.1).point);
        let gap = chord_gap(ends(part_a, on_a), ends(part_b, on_b));
        if gap > bulge_a + bulge_b + touch {
            continue;
        }
        if bulge_a.max(bulge_b) <= touch {
            let (chord_a, chord_b) = (ends(part_a, on_a), ends(part_b, on_b));
            let arc = |(primitive, piece): (&Primitive, &Piece), part: (f64, f64), fraction: f64| {
                let parameter = part.0 + fraction * (part.1 - part.0);
                piece.offset + arc_length(primitive, piece.from, parameter)
            };
            let first = arc((on_a, a), part_a, crossing(chord_a, chord_b));
            let second = arc((on_b, b), part_b, crossing(chord_b, chord_a));
            if counts(first, second) {
                return Some((first, second));
            }
            continue;
        }
        if bulge_a >= bulge_b {
            let middle = 0.5 * (part_a.0 + part_a.1);
            stack.extend([((middle, part_a.1), part_b), ((part_a.0, middle), part_b)]);
        } else {
            let middle = 0.5 * (part_b.0 + part_b.1);
            stack.extend([(part_a, (middle, part_b.1)), (part_a, (part_b.0, middle))]);
        }
    }
    None
}

type Chord = (Vector2<f64>, Vector2<f64>);

/// Fraction of `chord` at which the line through `other` crosses it; its start if they are parallel.
fn crossing(chord: Chord, other: Chord) -> f64 {
    let side = |point: Vector2<f64>| (other.1 - other.0).perp(&(point - other.0));
    let (start, end) = (side(chord.0), side(chord.1));
    if start == end { 0.0 } else { (start / (start - end)).clamp(0.0, 1.0) }
}

/// Distance between two straight pieces; zero if they cross.
fn chord_gap(a: Chord, b: Chord) -> f64 {
    let side = |line: Chord, point: Vector2<f64>| (line.1 - line.0).perp(&(point - line.0));
    if side(a, b.0) * side(a, b.1) < 0.0 && side(b, a.0) * side(b, a.1) < 0.0 {
        return 0.0;
    }
    [(a.0, b), (a.1, b), (b.0, a), (b.1, a)]
        .into_iter()
        .map(|(point, chord)| distance_to_chord(point, chord.0, chord.1).0)
        .fold(f64::INFINITY, f64::min)
}
