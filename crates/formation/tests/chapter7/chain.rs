//! What 7.10 starts with.
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveShape};
use trench_formation::hull::{Obstacle, Shape};
use trench_formation::kinematics::PointState;
use trench_formation::laws::NearestAttraction;
use trench_formation::seek::{LeaderRule, SeekSettings};
use trench_formation::simulate::{Carriage, ChainScenario, Encroaching, Options};
use trench_formation::trench::Hyperbolic;
use trench_formation::zoning::{Edge, ObstaclePotential, Radii, Sharpness, Zoning};

/// Table 6.1.
const STARTS: [[f64; 4]; 10] = [
    [26.0026, 29.7094, 0.0153, 0.0056],
    [27.8260, 19.8633, 0.7468, 0.4189],
    [25.4281, 16.7758, 0.4451, -0.1422],
    [14.8357, 21.3381, 0.9318, -0.3908],
    [14.2419, 15.1141, 0.4660, -0.6207],
    [13.7641, 8.8730, 0.4186, -0.6131],
    [12.3089, 4.2053, 0.8462, 0.3644],
    [9.7197, 1.0574, 0.5252, -0.3945],
    [1.5191, 3.0657, 0.2026, 0.0833],
    [0.7206, -1.0582, 0.6721, -0.6983],
];
/// Centres of the discs of 7.10.
pub(crate) const DISCS: [[f64; 2]; 4] = [[30.0, 25.0], [40.0, 43.0], [84.0, 86.0], [92.0, 90.0]];

/// 7.10 with damping k, its four discs, nearest points on the whole segment, 1 ms.
pub(crate) fn chain_of_7_10(damping: f64) -> ChainScenario<Hyperbolic> {
    let robot = |[x, y, vx, vy]: [f64; 4]| PointState { position: Vector2::new(x, y), velocity: Vector2::new(vx, vy) };
    let disc = |(id, [x, y]): (u32, [f64; 2])| Obstacle { id, shape: Shape::new(&[Vector2::new(x, y)], 0.0).unwrap() };
    let radii = Radii::new(1.0, 4.0, 10.0, 13.0, 30.0).unwrap();
    let diagonal = CurveShape::Line(Vector2::new(-5.0, -5.0), Vector2::new(100.0, 100.0));
    ChainScenario {
        segment: Curve::new(&diagonal, false, false).unwrap(),
        carriage: Carriage::parked(),
        team_goal: Some(Vector2::new(100.0, 100.0)),
        robots: STARTS.map(robot).to_vec(),
        law: NearestAttraction { trench: Hyperbolic { alpha: 10.0, a: 1.0 }, damping, leader_damping: 0.0 },
        zoning: Zoning::new(radii, (10.0, 10.0), Sharpness::Two, Edge::Jump, 1e4).unwrap(),
        obstacles: (0..).zip(DISCS).map(disc).collect(),
        clearance: 2.0,
        potential: ObstaclePotential::new(2.0, 3.0, 10.0, Sharpness::Two, Edge::Jump, 1e4).unwrap(),
        seeking: SeekSettings {
            room: 0.0,
            transit_margin: 1e-3,
            settled_distance: 0.05,
            settled_speed: 0.05,
            leader_rule: LeaderRule::StepSix,
        },
        encroaching: Encroaching::Nothing,
        remedies: None,
        options: Options::default(),
        step: 0.001,
        steps_per_tick: 1,
    }
}
