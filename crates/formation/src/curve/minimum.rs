//! Certified minima of the distance from a point to one piece.
//!
//! With g(u) = (p - q).p' (half the derivative of the squared distance), g' = |p'|^2 + (p - q).p'' and
//! |g''| <= 3 |p'| |p''| + |p - q| |p'''|. On an interval where these bounds give g' a sign, either one safeguarded
//! Newton run finds the only minimum, or there is none inside; where they do not, the interval is halved. An interval
//! is dropped when its chord is farther than the reach plus its sagitta: no minimum can be missed.
use super::bend::{Bend, Middle};
use super::piece::{Piece, distance_to_chord, sagitta};
use super::primitive::{Jet, Primitive};
use nalgebra::Vector2;

/// An interval halved this often is called a (degenerate) minimum itself: only a centre of curvature comes this far.
const MOST_SPLITS: u32 = 20;

/// After so many intervals of a piece, those over which the squared distance hardly changes are not halved any more: where a curve runs about
/// the point as a circle does, none decides by halving. A minimum that is one is found long before.
const MANY: u32 = 512;

/// What the squared distance hardly changes by, as a part of it: distances are the same, then, for those who compare them.
const FLAT: f64 = 1e-9;

/// A Newton step shorter than this part of an interval on which g' has a sign is the last: what is left then is below its square.
const LAST_STEP: f64 = 1e-8;

/// A minimum strictly inside a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Minimum {
    /// At one parameter, to within `width` in the parameter (0 unless degenerate), and the primitive there.
    At { parameter: f64, distance: f64, width: f64, jet: Jet },
    /// The whole piece is part of a circle about the point.
    Everywhere { distance: f64 },
}

impl Minimum {
    fn at(primitive: &Primitive, parameter: f64, width: f64, point: Vector2<f64>) -> Self {
        let jet = primitive.evaluate(parameter);
        Self::At { parameter, distance: (jet.point - point).norm(), width, jet }
    }
}

/// Calls `found` with every interior minimum of the distance from `point` to the piece that can be within `reach`;
/// `found` returns the reach from then on.
pub(super) fn interior_minima(
    primitive: &Primitive,
    piece: &Piece,
    point: Vector2<f64>,
    reach: f64,
    mut found: impl FnMut(Minimum) -> f64,
) {
    if let Primitive::Line { start, direction } = primitive {
        let parameter = (point - start).dot(direction);
        if piece.from < parameter && parameter < piece.to {
            found(Minimum::at(primitive, parameter, 0.0, point));
        }
    } else if let Some((centre, radius)) = primitive.circle() {
        found_on_circle(primitive, piece, point - centre, radius, found);
    } else if let Some(bend) = &piece.bend {
        // What the first interval asks is known beforehand.
        if distance_to_chord(point, piece.start, piece.end).0 > reach + piece.sagitta {
            return;
        }
        match bend.middle.slope_sign(point) {
            Some(true) => {
                let slopes = bend.slopes(point);
                if slopes[0] < 0.0 && slopes[1] > 0.0 {
                    let (parameter, jet) = on_bend(primitive, piece, bend, point, slopes);
                    found(Minimum::At { parameter, distance: (jet.point - point).norm(), width: 0.0, jet });
                }
            }
            Some(false) => {}
            None => by_halves(primitive, (piece.from, piece.to), point, reach, found),
        }
    } else {
        by_halves(primitive, (piece.from, piece.to), point, reach, found);
    }
}

/// Where on a piece the distance is least.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Least {
    Start,
    End,
    /// At a parameter, where the primitive is so.
    Inside(f64, Jet),
}

/// The minimum of a piece on which g grows everywhere; nothing if it may not.
#[inline]
pub(super) fn only_minimum(primitive: &Primitive, piece: &Piece, point: Vector2<f64>) -> Option<Least> {
    if let Primitive::Line { start, direction } = primitive {
        let parameter = (point - start).dot(direction);
        return Some(if parameter <= piece.from {
            Least::Start
        } else if parameter >= piece.to {
            Least::End
        } else {
            Least::Inside(parameter, primitive.evaluate(parameter))
        });
    }
    let bend = piece.bend.as_ref().filter(|bend| bend.middle.slope_sign(point) == Some(true))?;
    let slopes = bend.slopes(point);
    Some(if slopes[0] >= 0.0 {
        Least::Start
    } else if slopes[1] <= 0.0 {
        Least::End
    } else {
        let (parameter, jet) = on_bend(primitive, piece, bend, point, slopes);
        Least::Inside(parameter, jet)
    })
}

/// The minimum of a piece on which g grows and changes sign, from `slopes` at its ends.
#[inline]
fn on_bend(primitive: &Primitive, piece: &Piece, bend: &Bend, point: Vector2<f64>, slopes: [f64; 2]) -> (f64, Jet) {
    bend.root(point, slopes).unwrap_or_else(|(bracket, guess)| {
        let parameter = solve(primitive, bracket, guess, point, LAST_STEP * (piece.to - piece.from));
        (parameter, primitive.evaluate(parameter))
    })
}

/// [`interior_minima`] of a primitive between two parameters.
fn by_halves(
    primitive: &Primitive,
    (from, to): (f64, f64),
    point: Vector2<f64>,
    mut reach: f64,
    mut found: impl FnMut(Minimum) -> f64,
) {
    let mut stack = [(0.0, 0.0, 0); MOST_SPLITS as usize + 2];
    stack[0] = (from, to, 0);
    let (mut used, mut looked) = (1, 0);
    while used > 0 {
        used -= 1;
        looked += 1;
        let (from, to, depth) = stack[used];
        let (low, high) = (primitive.evaluate(from), primitive.evaluate(to));
        let (to_chord, fraction) = distance_to_chord(point, low.point, high.point);
        if to_chord > reach + sagitta(primitive, from, to) {
            continue;
        }
        match Middle::of(primitive, from, to).slope_sign(point) {
            Some(true) => {
                if changes_sign(&low, &high, point) {
                    let guess = from + fraction * (to - from);
                    let parameter = solve(primitive, (from, to), guess, point, LAST_STEP * (to - from));
                    reach = found(Minimum::at(primitive, parameter, 0.0, point));
                }
            }
            Some(false) => {}
            None if depth == MOST_SPLITS || (looked > MANY && is_flat(&low, &high, point, to - from)) => {
                reach = found(Minimum::at(primitive, 0.5 * (from + to), to - from, point));
            }
            None => {
                let middle = 0.5 * (from + to);
                stack[used] = (middle, to, depth + 1);
                stack[used + 1] = (from, middle, depth + 1);
                used += 2;
            }
        }
    }
}

/// Whether the squared distance from `point` hardly changes over a short part of this `width`, as far as g and g' at its ends tell.
fn is_flat(low: &Jet, high: &Jet, point: Vector2<f64>, width: f64) -> bool {
    let slope = |jet: &Jet| jet.slope(point).abs() + width * jet.growth(point).abs();
    2.0 * width * slope(low).max(slope(high)) <= FLAT * (low.point - point).norm_squared()
}

/// Whether g is negative at one jet and positive at the other.
fn changes_sign(low: &Jet, high: &Jet, point: Vector2<f64>) -> bool {
    low.slope(point) < 0.0 && high.slope(point) > 0.0
}

fn found_on_circle(
    primitive: &Primitive,
    piece: &Piece,
    arm: Vector2<f64>,
    radius: f64,
    mut found: impl FnMut(Minimum) -> f64,
) {
    let distance = arm.norm();
    if distance <= 1e-12 * radius {
        found(Minimum::Everywhere { distance: radius - distance });
        return;
    }
    let Primitive::Ellipse { cosine, sine, .. } = primitive else { return };
    let angle = libm::atan2(arm.dot(sine), arm.dot(cosine));
    let turns = libm::floor((angle - piece.from) / core::f64::consts::TAU);
    let parameter = angle - turns * core::f64::consts::TAU;
    if piece.from < parameter && parameter < piece.to {
        let jet = primitive.evaluate(parameter);
        found(Minimum::At { parameter, distance: (distance - radius).abs(), width: 0.0, jet });
    }
}

/// Root of g in [low, high], where g(low) <= 0 <= g(high): Newton from `start`, bisection where Newton leaves the
/// bracket. A Newton step of no more than `enough` is the last.
pub(super) fn solve(primitive: &Primitive, bracket: (f64, f64), start: f64, point: Vector2<f64>, enough: f64) -> f64 {
    let (mut low, mut high) = bracket;
    let tolerance = 1e-15 * low.abs().max(high.abs());
    let mut u = start.clamp(low, high);
    for _ in 0..60 {
        let jet = primitive.evaluate(u);
        let value = jet.slope(point);
        if value > 0.0 {
            high = u;
        } else {
            low = u;
        }
        let newton = u - value / jet.growth(point);
        let (next, least) = if newton >= low && newton <= high {
            (newton, tolerance.max(enough))
        } else {
            (0.5 * (low + high), tolerance)
        };
        if (next - u).abs() <= least {
            return next;
        }
        u = next;
    }
    u
}

#[cfg(test)]
mod tests {
    use crate::Vector2;
    use crate::curve::{Curve, CurveShape};
    use trench_expression::Expression;

    /// From the centre of a circle that is written as a graph, or is an ellipse but for a nanometre, all points are as near.
    #[test]
    fn centres_of_what_is_nearly_a_circle() {
        let graph = Expression::parse("sqrt(9 - x^2)").unwrap();
        let shapes = [
            CurveShape::Graph { function: graph, from: -2.5, to: 2.5 },
            CurveShape::Ellipse { centre: Vector2::zeros(), semi_axes: [3.0, 3.0 + 1e-9], rotation: 0.2 },
        ];
        for shape in shapes {
            let curve = Curve::new(&shape, false, false).unwrap();
            for off in [0.0, 1e-12, 1e-9, 1e-6] {
                let foot = curve.nearest(Vector2::new(off, 0.3 * off));
                assert!((foot.distance - 3.0).abs() < 2e-6, "{foot:?}");
                assert!(curve.nearest_all(Vector2::new(off, 0.3 * off)).feet.len() < 100_000);
            }
        }
    }
}
