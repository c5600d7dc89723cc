//! The chain of 7.10.
mod bounded;
mod chain;
mod scenarios;

use chain::DISCS;
pub(crate) use chain::chain_of_7_10;
use trench_formation::Vector2;
use trench_formation::kinematics::PointState;
use trench_formation::simulate::{ChainScenario, ChainSimulation};
use trench_formation::trench::Hyperbolic;

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
