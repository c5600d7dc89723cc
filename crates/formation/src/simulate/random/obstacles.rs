//! The obstacles of a random team.
use super::chance::Chance;
use super::concave::{HALF_WALL, random_walls};
use super::{CAPABILITY, CLEARANCE};
use crate::Vector2;
use crate::hull::{Obstacle, Shape};

/// For how long moving obstacles keep two clearances from all others, s, and how often that is looked at.
const HORIZON: f64 = 200.0;
const LOOKS: u32 = 400;
/// Half a side of the square in which obstacles begin, m.
const HALF: f64 = 10.0;
/// Part of the obstacles that are concave, where some are.
const CONCAVE: f64 = 0.7;

/// Obstacles with their velocities.
#[derive(Default)]
pub(super) struct Field {
    /// What bodies run into: of concave obstacles their pieces.
    pub(super) obstacles: Vec<Obstacle>,
    pub(super) velocities: Vec<Vector2<f64>>,
    /// The hull of each obstacle with its velocity.
    hulls: Vec<(Shape, Vector2<f64>)>,
    /// Which of them have mouths.
    concave: Vec<usize>,
}

/// What a gap is measured from.
#[derive(Clone, Copy)]
pub(super) enum Boundary {
    /// That of the obstacles themselves: a place in the mouth of a concave one may be clear of it.
    Real,
    /// That of their hulls.
    Hull,
}

impl Field {
    /// Up to six obstacles, two of which at most move; with `concave` most of them are L, U or crescents, else polygons, whose hulls are
    /// what robots know of them.
    pub(super) fn random(chance: &mut Chance, concave: bool) -> Self {
        let wanted = chance.below(7);
        let mut field = Self::default();
        let mut moving = 0;
        for id in 0..4 * wanted {
            if field.hulls.len() == wanted as usize {
                break;
            }
            let centre = chance.point(HALF);
            let moves = moving < 2 && chance.fraction() < 0.3;
            let speed = if moves { chance.between(0.05, 0.5 * CAPABILITY.speed) } else { 0.0 };
            let velocity = speed * chance.direction();
            let Some((hull, pieces)) = random_obstacle(chance, centre, concave) else { continue };
            if field.has_room(&hull, velocity) {
                moving += u32::from(moves);
                if pieces.len() > 1 {
                    field.concave.push(field.hulls.len());
                }
                let first = if concave { MOST_PIECES * id } else { id };
                for (id, shape) in (first..).zip(pieces) {
                    field.obstacles.push(Obstacle { id, shape });
                    field.velocities.push(velocity);
                }
                field.hulls.push((hull, velocity));
            }
        }
        field
    }

    /// Whether an obstacle never comes nearer than two clearances to the others.
    fn has_room(&self, shape: &Shape, velocity: Vector2<f64>) -> bool {
        self.hulls.iter().all(|(other, of_other)| {
            let relative = velocity - of_other;
            let between = HORIZON / f64::from(LOOKS);
            let limit = 2.0 * CLEARANCE + relative.norm() * between;
            let looks = if relative == Vector2::zeros() { 0 } else { LOOKS };
            (0..=looks).all(|look| {
                let moved = shape.moved(f64::from(look) * between * relative);
                moved.is_ok_and(|moved| !moved.outline().is_nearer_than(&other.outline(), limit))
            })
        })
    }

    /// A place within the hull of a concave obstacle, if one is found from which its walls are farther than `clear` (m).
    pub(super) fn mouth(&self, chance: &mut Chance, clear: f64) -> Option<Vector2<f64>> {
        if self.concave.is_empty() {
            return None;
        }
        let index = self.concave[chance.below(self.concave.len() as u32) as usize];
        let hull = self.hulls[index].0.outline();
        let (middle, half) = hull.disc_around();
        let fits = |point: &Vector2<f64>| {
            hull.approach(*point).gap < 0.0 && self.gap(*point, Boundary::Real, false, 2.0) > clear
        };
        (0..TRIES).map(|_| middle + chance.point(half)).find(fits)
    }

    /// Least gap from `point` to any obstacle, within the horizon if `ever`, less `lead` (s) of their motion, m.
    pub(super) fn gap(&self, point: Vector2<f64>, from: Boundary, ever: bool, lead: f64) -> f64 {
        let looks = if ever { LOOKS } else { 0 };
        let of = |shape: &Shape, velocity: &Vector2<f64>| {
            let looks = if *velocity == Vector2::zeros() { 0 } else { looks };
            let gap = |look: u32| {
                let seen = point - f64::from(look) * (HORIZON / f64::from(LOOKS)) * velocity;
                shape.outline().approach(seen).gap - lead * velocity.norm()
            };
            (0..=looks).map(gap).fold(f64::INFINITY, f64::min)
        };
        match from {
            Boundary::Hull => {
                self.hulls.iter().map(|(hull, velocity)| of(hull, velocity)).fold(f64::INFINITY, f64::min)
            }
            Boundary::Real => {
                let real = self.obstacles.iter().zip(&self.velocities);
                real.map(|(obstacle, velocity)| of(&obstacle.shape, velocity)).fold(f64::INFINITY, f64::min)
            }
        }
    }
}

/// Places looked at in a mouth.
const TRIES: u32 = 200;

/// More than any obstacle has.
const MOST_PIECES: u32 = 16;

/// The hull of an obstacle and its pieces: one, the hull itself, if it is not made of walls.
fn random_obstacle(chance: &mut Chance, centre: Vector2<f64>, concave: bool) -> Option<(Shape, Vec<Shape>)> {
    if concave && chance.fraction() < CONCAVE {
        let corners = random_walls(chance, centre);
        let pieces = corners.windows(2).map(|wall| Shape::new(wall, HALF_WALL).ok()).collect::<Option<_>>()?;
        return Some((Shape::enclosing(&corners, HALF_WALL).ok()?, pieces));
    }
    let hull = Shape::new(&random_corners(chance, centre), 0.0).ok()?;
    Some((hull.clone(), vec![hull]))
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
