//! The chain of 7.10.
mod scenarios;

use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveShape};
use trench_formation::hull::{Obstacle, Shape};
use trench_formation::kinematics::PointState;
use trench_formation::laws::NearestAttraction;
use trench_formation::seek::{LeaderRule, SeekSettings};
use trench_formation::simulate::{Carriage, ChainScenario, ChainSimulation, Encroaching};
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
        step: 0.001,
        steps_per_tick: 1,
    }
}

/// How 200 s went.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Run {
    pub(crate) robots: Vec<PointState>,
    pub(crate) deviations: Vec<f64>,
    /// Least distance of any pair, m.
    pub(crate) closest: f64,
    /// Least distance of any robot from each disc's centre, m.
    pub(crate) nearest_obstacles: [f64; 4],
}

impl Run {
    /// Whether every robot is within `tolerance` (m) of the diagonal.
    pub(crate) fn on_segment(&self, tolerance: f64) -> bool {
        self.robots.iter().all(|robot| (robot.position.x - robot.position.y).abs() < tolerance * 2.0_f64.sqrt())
    }
}

/// Runs 200 s.
pub(crate) fn run(scenario: ChainScenario<Hyperbolic>) -> Run {
    let steps = (200.0 / scenario.step).round() as u64;
    let mut simulation = ChainSimulation::new(scenario).unwrap();
    let (mut closest, mut nearest_obstacles) = (f64::INFINITY, [f64::INFINITY; 4]);
    for _ in 0..steps {
        simulation.step().unwrap();
        closest = closest.min(simulation.least_distance());
        for (nearest, disc) in nearest_obstacles.iter_mut().zip(DISCS) {
            for robot in simulation.robots() {
                *nearest = nearest.min((robot.position - Vector2::from(disc)).norm());
            }
        }
    }
    let (robots, deviations) = (simulation.robots().to_vec(), simulation.deviations().to_vec());
    Run { robots, deviations, closest, nearest_obstacles }
}
