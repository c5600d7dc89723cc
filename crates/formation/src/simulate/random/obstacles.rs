//! The obstacles of a random team.
use super::chance::Chance;
use super::{CAPABILITY, CLEARANCE};
use crate::Vector2;
use crate::hull::{Obstacle, Shape};

/// For how long moving obstacles keep two clearances from all others, s, and how often that is looked at.
const HORIZON: f64 = 200.0;
const LOOKS: u32 = 400;
/// Half a side of the square in which obstacles begin, m.
const HALF: f64 = 10.0;

/// Obstacles with their velocities.
pub(super) struct Field {
    pub(super) obstacles: Vec<Obstacle>,
    pub(super) velocities: Vec<Vector2<f64>>,
}

impl Field {
    /// Up to six obstacles, two of which at most move.
    pub(super) fn random(chance: &mut Chance) -> Self {
        let wanted = chance.below(7);
        let mut field = Self { obstacles: Vec::new(), velocities: Vec::new() };
        let mut moving = 0;
        for id in 0..4 * wanted {
            if field.obstacles.len() == wanted as usize {
                break;
            }
            let centre = chance.point(HALF);
            let moves = moving < 2 && chance.fraction() < 0.3;
            let speed = if moves { chance.between(0.05, 0.5 * CAPABILITY.speed) } else { 0.0 };
            let velocity = speed * chance.direction();
            let Ok(shape) = Shape::new(&random_corners(chance, centre), 0.0) else { continue };
            if field.has_room(&shape, velocity) {
                moving += u32::from(moves);
                field.obstacles.push(Obstacle { id, shape });
                field.velocities.push(velocity);
            }
        }
        field
    }

    /// Whether an obstacle never comes nearer than two clearances to the others.
    fn has_room(&self, shape: &Shape, velocity: Vector2<f64>) -> bool {
        self.obstacles.iter().zip(&self.velocities).all(|(other, of_other)| {
            let relative = velocity - of_other;
            let between = HORIZON / f64::from(LOOKS);
            let limit = 2.0 * CLEARANCE + relative.norm() * between;
            let looks = if relative == Vector2::zeros() { 0 } else { LOOKS };
            (0..=looks).all(|look| {
                let moved = shape.moved(f64::from(look) * between * relative);
                moved.is_ok_and(|moved| !moved.outline().is_nearer_than(&other.shape.outline(), limit))
            })
        })
    }

    /// Least gap from `point` to any obstacle, within the horizon if `ever`, less `lead` (s) of their motion, m.
    pub(super) fn gap(&self, point: Vector2<f64>, ever: bool, lead: f64) -> f64 {
        let looks = if ever { LOOKS } else { 0 };
        let of = |(obstacle, velocity): (&Obstacle, &Vector2<f64>)| {
            let looks = if *velocity == Vector2::zeros() { 0 } else { looks };
            let gap = |look: u32| {
                let seen = point - f64::from(look) * (HORIZON / f64::from(LOOKS)) * velocity;
                obstacle.shape.outline().approach(seen).gap - lead * velocity.norm()
            };
            (0..=looks).map(gap).fold(f64::INFINITY, f64::min)
        };
        self.obstacles.iter().zip(&self.velocities).map(of).fold(f64::INFINITY, f64::min)
    }
}

/// A polygon of random radii about its middle, concave where a radius is small.
fn random_corners(chance: &mut Chance, centre: Vector2<f64>) -> Vec<Vector2<f64>> {
    let size = chance.between(0.3, 1.2);
    let count = 4 + chance.below(6);
    let turn = chance.fraction();
    let corner = |index: u32| {
        let angle = core::f64::consts::TAU * (f64::from(index) + turn) / f64::from(count);
        let (sine, cosine) = libm::sincos(angle);
        centre + size * chance.between(0.3, 1.0) * Vector2::new(cosine, sine)
    };
    (0..count).map(corner).collect()
}
