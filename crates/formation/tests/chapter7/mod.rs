//! The chain of 7.10.
mod bounded;
mod chain;
mod scenarios;

use crate::edges::{Edges, counted};
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
    /// Jumps of the force and reversals at the edges of zones 2 and 4 of leaders, and at those of discs.
    pub(crate) edges: [(u32, u32); 3],
}

impl Run {
    /// Whether every follower is in the neutral zone of its leader, or beyond it by less than `outside` (m).
    pub(crate) fn is_neutral(&self, outside: f64) -> bool {
        let neutral =
            |pair: &[PointState]| (4.0..=10.0 + outside).contains(&(pair[0].position - pair[1].position).norm());
        self.robots.windows(2).all(neutral)
    }

    /// Whether every robot is within `tolerance` (m) of the diagonal.
    pub(crate) fn on_segment(&self, tolerance: f64) -> bool {
        self.robots.iter().all(|robot| (robot.position.x - robot.position.y).abs() < tolerance * 2.0_f64.sqrt())
    }
}

/// Runs 200 s.
pub(crate) fn run(scenario: ChainScenario<Hyperbolic>) -> Run {
    let steps = (200.0 / scenario.step).round() as u64;
    let (zoning, potential) = (scenario.zoning, scenario.potential);
    let discs: Vec<Vector2<f64>> = scenario.obstacles.iter().map(|disc| disc.shape.outline().points[0]).collect();
    let mut seen = [vec![Edges::default(); 9], vec![Edges::default(); 9], vec![Edges::default(); 10 * discs.len()]];
    let mut simulation = ChainSimulation::new(scenario).unwrap();
    let (mut closest, mut nearest_obstacles) = (f64::INFINITY, [f64::INFINITY; 4]);
    for _ in 0..steps {
        simulation.step().unwrap();
        let robots = simulation.robots();
        for (index, pair) in robots.windows(2).enumerate() {
            let distance = (pair[0].position - pair[1].position).norm();
            for (seen, edge) in seen.iter_mut().zip([zoning.radii().rho_hat, zoning.radii().rho]) {
                seen[index].see((distance, zoning.force(distance)), edge, 5.0 / 27.0);
            }
        }
        let gaps = robots.iter().flat_map(|robot| discs.iter().map(move |disc| (robot.position - disc).norm()));
        for (seen, gap) in seen[2].iter_mut().zip(gaps) {
            seen.see((gap, potential.force(gap)), potential.cut(), 5.0);
        }
        closest = closest.min(simulation.least_distance());
        for (nearest, disc) in nearest_obstacles.iter_mut().zip(DISCS) {
            for robot in simulation.robots() {
                *nearest = nearest.min((robot.position - Vector2::from(disc)).norm());
            }
        }
    }
    let (robots, deviations) = (simulation.robots().to_vec(), simulation.deviations().to_vec());
    Run { robots, deviations, closest, nearest_obstacles, edges: seen.each_ref().map(counted) }
}
