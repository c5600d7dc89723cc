//! Four robots side by side move alike on every processor.
use super::super::{ChainSimulation, Encroaching, random_team};
use super::*;
use crate::lanes::HIDDEN;
use crate::trench::Hyperbolic;

/// A random team that may go side by side: without remedies, and robots ahead take no places.
fn scenario(seed: u64) -> Option<ChainScenario<Hyperbolic>> {
    Some(ChainScenario { remedies: None, encroaching: Encroaching::Obstacles, ..random_team(seed)? })
}

/// Where the robots of each step are, bit for bit.
fn motion(scenario: &ChainScenario<Hyperbolic>, hidden: bool) -> Vec<[u64; 4]> {
    HIDDEN.set(hidden);
    let mut simulation = ChainSimulation::new(scenario.clone()).unwrap();
    let mut motion = Vec::new();
    for _ in 0..600 {
        simulation.step().unwrap();
        let bits = |robot: &PointState| {
            [robot.position.x, robot.position.y, robot.velocity.x, robot.velocity.y].map(f64::to_bits)
        };
        motion.extend(simulation.robots().iter().map(bits));
    }
    HIDDEN.set(false);
    motion
}

#[test]
fn processors_with_and_without_avx_move_robots_alike() {
    for (seed, scenario) in (0..30).filter_map(|seed| Some((seed, scenario(seed)?))) {
        let (with, without) = (motion(&scenario, false), motion(&scenario, true));
        let (first, last) = (with.iter(), with[with.len() - scenario.robots.len()..].iter());
        assert!(last.zip(first).all(|(last, first)| last != first), "seed {seed}: somebody never moved");
        assert_eq!(with, without, "seed {seed}");
    }
}
