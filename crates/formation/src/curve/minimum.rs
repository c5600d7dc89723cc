//! Certified minima of the distance from a point to one piece.
//!
//! With g(u) = (p - q).p' (half the derivative of the squared distance), g' = |p'|^2 + (p - q).p'' and
//! |g''| <= 3 |p'| |p''| + |p - q| |p'''|. On an interval where these bounds give g' a sign, either one safeguarded
//! Newton run finds the only minimum, or there is none inside; where they do not, the interval is halved. An interval
//! is dropped when its chord is farther than the reach plus its sagitta: no minimum can be missed.
use super::piece::{Piece, distance_to_chord, sagitta};
use super::primitive::Primitive;
use nalgebra::Vector2;

/// An interval halved this often is called a (degenerate) minimum itself: only a centre of curvature comes this far.
const MOST_SPLITS: u32 = 20;

/// A minimum strictly inside a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Minimum {
    /// At one parameter, to within `width` in the parameter (0 unless degenerate).
    At { parameter: f64, distance: f64, width: f64 },
    /// The whole piece is part of a circle about the point.
    Everywhere { distance: f64 },
}

/// Calls `found` with every interior minimum of the distance from `point` to the piece that can be within `reach`;
/// `found` returns the reach from then on.
pub(super) fn interior_minima(
    primitive: &Primitive,
    piece: &Piece,
    point: Vector2<f64>,
    mut reach: f64,
    mut found: impl FnMut(Minimum) -> f64,
) {
    if let Primitive::Line { start, direction } = primitive {
        let parameter = (point - start).dot(direction);
        if piece.from < parameter && parameter < piece.to {
            let distance = (start + parameter * direction - point).norm();
            found(Minimum::At { parameter, distance, width: 0.0 });
        }
        return;
    }
    if let Some((centre, radius)) = primitive.circle() {
        found_on_circle(primitive, piece, point - centre, radius, found);
        return;
    }
    let mut stack = [(0.0, 0.0, 0); MOST_SPLITS as usize + 2];
    stack[0] = (piece.from, piece.to, 0);
    let mut used = 1;
    while used > 0 {
        used -= 1;
        let (from, to, depth) = stack[used];
        let (low, high) = (primitive.evaluate(from), primitive.evaluate(to));
        let (to_chord, fraction) = distance_to_chord(point, low.point, high.point);
        if to_chord > reach + sagitta(primitive, from, to) {
            continue;
        }
        match slope_sign(primitive, from, to, point) {
            Some(true) => {
                if (low.point - point).dot(&low.first) < 0.0 && (high.point - point).dot(&high.first) > 0.0 {
                    let parameter = solve(primitive, (from, to), from + fraction * (to - from), point);
                    let distance = (primitive.evaluate(parameter).point - point).norm();
                    reach = found(Minimum::At { parameter, distance, width: 0.0 });
                }
            }
            Some(false) => {}
            None if depth == MOST_SPLITS => {
                let parameter = 0.5 * (from + to);
                let distance = (primitive.evaluate(parameter).point - point).norm();
                reach = found(Minimum::At { parameter, distance, width: to - from });
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
        found(Minimum::At { parameter, distance: (distance - radius).abs(), width: 0.0 });
    }
}

/// Whether g' is positive (true) or negative (false) on all of [from, to]; `None` if the bounds do not tell.
fn slope_sign(primitive: &Primitive, from: f64, to: f64, point: Vector2<f64>) -> Option<bool> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let jet = primitive.evaluate(middle);
    let away = jet.point - point;
    let (second, third) = primitive.derivative_bounds(middle, half);
    let most_speed = jet.first.norm() + half * second;
    let most_distance = away.norm() + half * most_speed;
    let slope = jet.first.norm_squared() + away.dot(&jet.second);
    let change = half * (3.0 * most_speed * second + most_distance * third);
    (slope.abs() > change).then_some(slope > 0.0)
}

/// Root of g in [low, high], where g(low) <= 0 <= g(high): Newton from `start`, bisection where Newton leaves the
/// bracket.
pub(super) fn solve(primitive: &Primitive, bracket: (f64, f64), start: f64, point: Vector2<f64>) -> f64 {
    let (mut low, mut high) = bracket;
    let tolerance = 1e-15 * low.abs().max(high.abs());
    let mut u = start.clamp(low, high);
    for _ in 0..60 {
        let jet = primitive.evaluate(u);
        let away = jet.point - point;
        let value = away.dot(&jet.first);
        if value > 0.0 {
            high = u;
        } else {
            low = u;
        }
        let newton = u - value / (jet.first.norm_squared() + away.dot(&jet.second));
        let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
        if (next - u).abs() <= tolerance {
            return next;
        }
        u = next;
    }
    u
}
