//! Segments of a random team besides the common ones: closed ones, graphs of expressions, queues with an open end.
use super::chance::Chance;
use super::segment::Room;
use crate::curve::CurveShape;
use core::f64::consts::{PI, TAU};
use trench_expression::Expression;

/// A segment with room for `count` robots, and whether its last end is open: a circle, an ellipse, y = f(x), or a line or polyline that goes on for
/// ever. Nothing where f cannot be written.
pub(super) fn random_other_segment(chance: &mut Chance, count: usize) -> Option<(CurveShape, bool)> {
    let room = Room::random(chance, count);
    let Room { length, middle, heading, .. } = room;
    Some(match chance.below(5) {
        0 => (CurveShape::Arc { centre: middle, radius: length / TAU, start_angle: heading, sweep: TAU }, false),
        1 => {
            // Two semi-axes of the mean square of which the circumference is at most that of a circle.
            let narrow = chance.between(0.4, 0.9);
            let wide = length / TAU * libm::sqrt(2.0 / (1.0 + narrow * narrow));
            (CurveShape::Ellipse { centre: middle, semi_axes: [wide, narrow * wide], rotation: heading }, false)
        }
        2 => {
            let waves = chance.between(1.0, 2.0);
            let (height, phase) = (chance.between(0.05, 0.15) * length / waves, chance.between(0.0, TAU));
            let bend = chance.between(-0.5, 0.5) / length;
            let text = format!("{height} * sin({} * x + {phase}) + {bend} * x^2", 2.0 * PI * waves / length);
            let function = Expression::parse(&text).ok()?;
            (CurveShape::Graph { function, from: -0.5 * length, to: 0.5 * length }, false)
        }
        3 => (room.line(), true),
        _ => (room.bent(chance), true),
    })
}
