//! Concave obstacles of a random team: L, U and crescents, of walls that touch.
use super::chance::Chance;
use crate::Vector2;
use core::f64::consts::PI;

/// Half the thickness of walls, m.
pub(super) const HALF_WALL: f64 = 0.08;
/// Pieces of a crescent.
const PIECES: u32 = 6;

/// Corners of an open chain of walls about a place: an L, a U, or a crescent. Mouths are wide enough for a robot to stand within, clear of
/// the walls.
pub(super) fn random_walls(chance: &mut Chance, centre: Vector2<f64>) -> Vec<Vector2<f64>> {
    let (along, kind) = (chance.direction(), chance.below(3));
    let across = Vector2::new(-along.y, along.x);
    let at = |x: f64, y: f64| centre + x * along + y * across;
    match kind {
        0 => {
            let (long, short) = (chance.between(1.2, 2.4), chance.between(1.2, 2.4));
            let slant = chance.between(-0.5, 0.5);
            vec![at(long, 0.0), at(0.0, 0.0), at(slant, short)]
        }
        1 => {
            let (half, deep, other) = (chance.between(0.7, 1.1), chance.between(1.0, 2.0), chance.between(1.0, 2.0));
            vec![at(deep, half), at(0.0, half), at(0.0, -half), at(other, -half)]
        }
        _ => {
            let (radius, sweep) = (chance.between(0.8, 1.3), chance.between(0.9, 1.4) * PI);
            let corner = |piece: u32| {
                let angle = PI - 0.5 * sweep + sweep * f64::from(piece) / f64::from(PIECES);
                let (sine, cosine) = libm::sincos(angle);
                at(radius * cosine, radius * sine)
            };
            (0..=PIECES).map(corner).collect()
        }
    }
}
