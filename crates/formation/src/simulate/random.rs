//! Random teams: robots, a segment and obstacles from a seed.
use super::{Carriage, ChainScenario, Encroaching, Options, Remedies};
use crate::Vector2;
use crate::avoidance::WatchSettings;
use crate::chain::{Robot, organise};
use crate::curve::{Curve, CurveShape, Placed};
use crate::hull::{Obstacle, Shape};
use crate::kinematics::PointState;
use crate::laws::{Capability, NearestAttraction};
use crate::seek::{LeaderRule, SeekSettings};
use crate::trench::Hyperbolic;
use crate::zoning::{Edge, ObstaclePotential, Radii, Sharpness, Zoning};
use nalgebra::Isometry2;

/// Radius of a robot's body, m.
pub const BODY_RADIUS: f64 = 0.1;
/// What the robots of random teams can do.
pub const CAPABILITY: Capability = Capability { speed: 0.5, acceleration: 2.0 };
/// Gap from obstacles below which they repel, m.
const CUT: f64 = 0.5;
/// rho_clearance, m.
const CLEARANCE: f64 = 1.0;
/// For how long a moving obstacle keeps two clearances from all others, s.
const HORIZON: f64 = 200.0;
/// Half a side of the square in which things begin, m.
const FIELD: f64 = 10.0;

/// Chance from a Weyl sequence with a mixer (splitmix64).
struct Chance(u64);

impl Chance {
    fn fraction(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.fraction()
    }

    fn below(&mut self, count: u32) -> u32 {
        (self.fraction() * f64::from(count)) as u32
    }

    fn point(&mut self, half: f64) -> Vector2<f64> {
        Vector2::new(self.between(-half, half), self.between(-half, half))
    }

    fn direction(&mut self) -> Vector2<f64> {
        let (sine, cosine) = libm::sincos(self.between(0.0, core::f64::consts::TAU));
        Vector2::new(cosine, sine)
    }
}

/// The scenario of a seed: 2 to 20 robots at rest, one segment (line, arc or sinusoid), up to six obstacles, concave ones among
/// them, up to two of which move with at most half of the robots' speed. Gaps between obstacles are at least two clearances, along
/// the whole way of those that move; no robot begins within its stopping distance of a repulsive zone. Nothing where no place was
/// found for the robots. Teams may be infeasible: see [`judge`](super::judge).
pub fn random_team(seed: u64) -> Option<ChainScenario<Hyperbolic>> {
    let mut chance = Chance(seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
    let count = 2 + chance.below(19) as usize;
    let segment = Curve::new(&random_segment(&mut chance, count), false, false).ok()?;
    let (obstacles, velocities) = random_obstacles(&mut chance);
    let placed = Placed::new(&segment, Isometry2::identity());
    let team_goal = free_point(&placed, &obstacles, &velocities);
    let positions = random_starts(&mut chance, count, &obstacles, &velocities)?;
    let names: Vec<String> = (0..count).map(|index| format!("{index:02}")).collect();
    let robots: Vec<Robot<'_>> =
        names.iter().zip(&positions).map(|(name, position)| Robot { name, position: *position }).collect();
    let chain = organise(&robots, team_goal, &placed).ok()?;
    let by_rank = |name: &String| names.iter().position(|other| other == name).map(|index| positions[index]);
    let robots = chain.names().iter().filter_map(by_rank).map(PointState::at_rest).collect();
    let radii = Radii::new(0.4, 1.0, 3.0, 6.0, 10.0).ok()?;
    Some(ChainScenario {
        segment,
        carriage: Carriage::parked(),
        team_goal: Some(team_goal),
        robots,
        law: NearestAttraction { trench: Hyperbolic { alpha: 1.0, a: 0.5 }, damping: 2.0, leader_damping: 0.0 },
        zoning: Zoning::new(radii, (0.2, 0.05), Sharpness::One, Edge::Continuous, 6.0).ok()?,
        obstacles,
        clearance: CLEARANCE,
        potential: ObstaclePotential::new(0.2, CUT, 0.1, Sharpness::One, Edge::Continuous, 6.0).ok()?,
        seeking: SeekSettings {
            room: 0.05,
            transit_margin: 0.05,
            settled_distance: 0.1,
            settled_speed: 0.05,
            leader_rule: LeaderRule::StepSix,
        },
        encroaching: Encroaching::ObstaclesAndRobots(BODY_RADIUS),
        remedies: Some(Remedies { watch: WatchSettings { radius: 0.15, patience: 2.0, arrived: 0.1 }, rising: 0.3 }),
        options: Options {
            limits: Some(CAPABILITY),
            sidesteps: true,
            obstacle_velocities: velocities,
            ..Options::default()
        },
        step: 0.005,
        steps_per_tick: 6,
    })
}

fn random_segment(chance: &mut Chance, count: usize) -> CurveShape {
    let length = 2.0 * count as f64 + chance.between(3.0, 8.0);
    let middle = chance.point(2.0);
    let direction = chance.direction();
    let start = middle - 0.5 * length * direction;
    match chance.below(3) {
        0 => CurveShape::Line(start, start + length * direction),
        1 => {
            let across = Vector2::new(-direction.y, direction.x) * chance.between(0.1, 0.3) * length;
            CurveShape::Bezier(vec![start, middle + across, start + length * direction])
        }
        _ => CurveShape::Polyline(vec![
            start,
            middle + Vector2::new(-direction.y, direction.x) * chance.between(-0.2, 0.2) * length,
            start + length * direction,
        ]),
    }
}

fn random_obstacles(chance: &mut Chance) -> (Vec<Obstacle>, Vec<Vector2<f64>>) {
    let wanted = chance.below(7);
    let (mut obstacles, mut velocities, mut swept) = (Vec::new(), Vec::new(), Vec::<Shape>::new());
    let mut moving = 0;
    for id in 0..4 * wanted {
        if obstacles.len() == wanted as usize {
            break;
        }
        let centre = chance.point(FIELD);
        let moves = moving < 2 && chance.fraction() < 0.3;
        let speed = if moves { chance.between(0.05, 0.5 * CAPABILITY.speed) } else { 0.0 };
        let velocity = speed * chance.direction();
        let corners = random_corners(chance, centre);
        let end = corners.iter().map(|corner| corner + HORIZON * velocity);
        let way: Vec<Vector2<f64>> = corners.iter().copied().chain(end).collect();
        // The way of a polygon is the hull of its beginning and its end; their corners need no order.
        let (Ok(shape), Ok(way)) = (Shape::new(&corners, 0.0), hull_of(&way)) else { continue };
        if swept.iter().any(|other| other.outline().is_nearer_than(&way.outline(), 2.0 * CLEARANCE)) {
            continue;
        }
        moving += u32::from(moves);
        obstacles.push(Obstacle { id, shape });
        velocities.push(velocity);
        swept.push(way);
    }
    (obstacles, velocities)
}

/// Shape of points in any order: sorted around their middle they do not cross.
fn hull_of(points: &[Vector2<f64>]) -> Result<Shape, crate::hull::HullError> {
    let middle = points.iter().sum::<Vector2<f64>>() / points.len() as f64;
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| {
        let angle = |point: &Vector2<f64>| libm::atan2(point.y - middle.y, point.x - middle.x);
        angle(a).total_cmp(&angle(b))
    });
    Shape::new(&sorted, 0.0)
}

/// A disc-like polygon of random radii, concave where a radius is small: an L or a star.
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

/// An end of the segment, or the first point on from there that no obstacle will cover.
fn free_point(segment: &Placed<'_>, obstacles: &[Obstacle], velocities: &[Vector2<f64>]) -> Vector2<f64> {
    let length = segment.curve().length();
    let covered = |point: Vector2<f64>| {
        obstacles.iter().zip(velocities).any(|(obstacle, velocity)| {
            (0..=200).any(|tick| {
                let seen = point - f64::from(tick) * 0.005 * HORIZON * velocity;
                obstacle.shape.outline().approach(seen).gap < CUT + 0.2
            })
        })
    };
    let points = (0..=100).map(|index| segment.at(length * (1.0 - f64::from(index) / 100.0)).point);
    points.clone().find(|point| !covered(*point)).unwrap_or_else(|| segment.at(length).point)
}

fn random_starts(
    chance: &mut Chance,
    count: usize,
    obstacles: &[Obstacle],
    velocities: &[Vector2<f64>],
) -> Option<Vec<Vector2<f64>>> {
    let (middle, half) = (chance.point(0.5 * FIELD), 3.0 + 0.35 * count as f64);
    let stopping = CAPABILITY.speed * CAPABILITY.speed / (2.0 * CAPABILITY.acceleration);
    let mut positions: Vec<Vector2<f64>> = Vec::with_capacity(count);
    for _ in 0..1000 {
        let point = middle + chance.point(half);
        let clear = obstacles.iter().zip(velocities).all(|(obstacle, velocity)| {
            obstacle.shape.outline().approach(point).gap > CUT + stopping + 2.0 * velocity.norm()
        });
        if clear && positions.iter().all(|other| (other - point).norm() > 1.0) {
            positions.push(point);
        }
        if positions.len() == count {
            return Some(positions);
        }
    }
    None
}
