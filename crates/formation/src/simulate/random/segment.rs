//! The segment of a random team.
use super::chance::Chance;
use crate::Vector2;
use crate::curve::CurveShape;
use core::f64::consts::PI;

/// Where a segment lies, and how long it is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Room {
    /// m: 2 m for each robot and more.
    pub(super) length: f64,
    pub(super) middle: Vector2<f64>,
    /// rad.
    pub(super) heading: f64,
    along: Vector2<f64>,
    across: Vector2<f64>,
}

impl Room {
    /// For `count` robots, about the middle of the field.
    pub(super) fn random(chance: &mut Chance, count: usize) -> Self {
        let length = 2.0 * count as f64 + chance.between(3.0, 8.0);
        let middle = chance.point(2.0);
        let heading = chance.between(0.0, 2.0 * PI);
        let (sine, cosine) = libm::sincos(heading);
        Self { length, middle, heading, along: Vector2::new(cosine, sine), across: Vector2::new(-sine, cosine) }
    }

    /// A point along and across, in lengths from the middle.
    pub(super) fn at(&self, x: f64, y: f64) -> Vector2<f64> {
        self.middle + self.length * (x * self.along + y * self.across)
    }

    pub(super) fn line(&self) -> CurveShape {
        CurveShape::Line(self.at(-0.5, 0.0), self.at(0.5, 0.0))
    }

    /// Two pieces with a bend between them.
    pub(super) fn bent(&self, chance: &mut Chance) -> CurveShape {
        CurveShape::Polyline(vec![self.at(-0.5, 0.0), self.at(0.0, chance.between(-0.2, 0.2)), self.at(0.5, 0.0)])
    }
}

/// A segment with room for `count` robots: a line, arc, sinusoid, spline, Bezier curve or polyline about the middle of the field.
pub(super) fn random_segment(chance: &mut Chance, count: usize) -> CurveShape {
    let room = Room::random(chance, count);
    let Room { length, middle, heading, across, .. } = room;
    let at = |x: f64, y: f64| room.at(x, y);
    match chance.below(6) {
        0 => room.line(),
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
        _ => room.bent(chance),
    }
}
