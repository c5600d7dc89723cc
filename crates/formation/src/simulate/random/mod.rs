//! Random teams: robots, a segment and obstacles from a seed.
mod chance;
mod concave;
mod obstacles;
mod other;
mod segment;
mod starts;

use self::chance::Chance;
use self::obstacles::{Boundary, Field};
use self::other::random_other_segment;
use self::segment::random_segment;
use self::starts::random_starts;
use super::{Carriage, ChainScenario, Encroaching, Options, Remedies};
use crate::Vector2;
use crate::avoidance::WatchSettings;
use crate::curve::{Curve, CurveShape, Placed};
use crate::kinematics::PointState;
use crate::laws::{Capability, NearestAttraction};
use crate::safety::Stopping;
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
/// The scenario of a seed: 2 to 20 robots at rest, one segment (line, arc, sinusoid, spline, Bezier curve or polyline), up to six
/// obstacles, polygons, of which robots know the hulls; up to two of them move with at most half of the robots' speed. Gaps between
/// obstacles are at least two clearances, along the whole way of those that move; no robot begins within its stopping distance of a
/// repulsive zone. Nothing where no place was found for the robots. Teams may be infeasible: see [`judge`](super::judge).
pub fn random_team(seed: u64) -> Option<ChainScenario<Hyperbolic>> {
    team(seed, false, common)
}

/// As [`random_team`], on other segments: a circle, an ellipse, the graph of an expression, a line or a polyline with an open end.
pub fn random_team_on_other_segments(seed: u64) -> Option<ChainScenario<Hyperbolic>> {
    team(seed, false, random_other_segment)
}

/// As [`random_team`], but most obstacles are concave: L, U and crescents made of walls. Gaps are those between their hulls; robots may
/// begin in their mouths, within the hulls, as far from the walls as others from obstacles.
pub fn random_team_among_concave_obstacles(seed: u64) -> Option<ChainScenario<Hyperbolic>> {
    team(seed, true, common)
}

/// A segment for so many robots, and whether its last end is open.
type Segments = fn(&mut Chance, usize) -> Option<(CurveShape, bool)>;

fn common(chance: &mut Chance, count: usize) -> Option<(CurveShape, bool)> {
    Some((random_segment(chance, count), false))
}

fn team(seed: u64, concave: bool, segments: Segments) -> Option<ChainScenario<Hyperbolic>> {
    let mut chance = Chance(seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
    let count = 2 + chance.below(19) as usize;
    let (shape, open) = segments(&mut chance, count)?;
    let segment = Curve::new(&shape, false, open).ok()?;
    let field = Field::random(&mut chance, concave);
    let placed = Placed::new(&segment, Isometry2::identity());
    let team_goal = free_point(&placed, &field);
    let radii = Radii::new(0.4, 1.0, 7.0, 9.0, 10.0).ok()?;
    let starts = random_starts(&mut chance, count, &field, (&placed, team_goal, &radii))?;
    let Field { obstacles, velocities, .. } = field;
    Some(ChainScenario {
        segment,
        carriage: Carriage::parked(),
        team_goal: Some(team_goal),
        robots: starts.into_iter().map(PointState::at_rest).collect(),
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
        encroaching: Encroaching::ObstaclesAndPlaces(radii.rho_hat - CUT),
        remedies: Some(Remedies { watch: WatchSettings { radius: 0.15, patience: 2.0, arrived: 0.1 }, rising: 0.3 }),
        options: Options {
            limits: Some(CAPABILITY),
            sidesteps: true,
            obstacle_velocities: velocities,
            safety: Some(Stopping { radius: BODY_RADIUS + 0.01, capability: CAPABILITY }),
            ..Options::default()
        },
        step: 0.01,
        steps_per_tick: 3,
    })
}

/// An end of the segment, or the first point on from there that no obstacle will ever cover.
fn free_point(segment: &Placed<'_>, field: &Field) -> Vector2<f64> {
    let length = segment.curve().length();
    let points = (0..=100).map(|index| segment.at(length * (1.0 - f64::from(index) / 100.0)).point);
    points
        .clone()
        .find(|point| field.gap(*point, Boundary::Hull, true, 0.0) >= CUT + 0.2)
        .unwrap_or_else(|| segment.at(length).point)
}
