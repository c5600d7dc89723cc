//! The segment of a random team.
use super::chance::Chance;
use crate::Vector2;
use crate::curve::CurveShape;
use core::f64::consts::PI;

/// A segment with room for `count` robots: a line, arc, sinusoid, spline, Bezier curve or polyline about the middle of the field.
pub(super) fn random_segment(chance: &mut Chance, count: usize) -> CurveShape {
    let length = 2.0 * count as f64 + chance.between(3.0, 8.0);
    let middle = chance.point(2.0);
    let heading = chance.between(0.0, 2.0 * PI);
    let (sine, cosine) = libm::sincos(heading);
    let (along, across) = (Vector2::new(cosine, sine), Vector2::new(-sine, cosine));
    let at = |x: f64, y: f64| middle + length * (x * along + y * across);
    match chance.below(6) {
        0 => CurveShape::Line(at(-0.5, 0.0), at(0.5, 0.0)),
        1 => {
            let sweep = chance.between(0.3, 1.3) * PI;
            let radius = length / sweep;
            CurveShape::Arc { centre: middle - radius * across, radius, start_angle: heading, sweep }
        }
        2 => {
            let wavelength = length / chance.between(1.0, 2.0);
            let (amplitude, phase) = (chance.between(0.05, 0.15) * wavelength, chance.between(0.0, 2.0 * PI));
            CurveShape::Sinusoid { origin: at(-0.5, 0.0), direction: heading, length, amplitude, wavelength, phase }
        }
        3 => {
            let mut bend = || chance.between(-0.15, 0.15);
            CurveShape::Spline(vec![at(-0.5, bend()), at(-0.15, bend()), at(0.2, bend()), at(0.5, bend())])
        }
        4 => {
            let mut bend = || chance.between(-0.3, 0.3);
            CurveShape::Bezier(vec![at(-0.5, bend()), at(-0.2, bend()), at(0.2, bend()), at(0.5, bend())])
        }
        _ => CurveShape::Polyline(vec![at(-0.5, 0.0), at(0.0, chance.between(-0.2, 0.2)), at(0.5, 0.0)]),
    }
}
