//! 9.2: bounded acceleration and speed with the stability argument kept (docs/theory/chapter7.md, "Bounded actuators").
use super::{chain_of_7_10, run};
use trench_formation::laws::{Capability, NearestAttraction};
use trench_formation::simulate::{ChainScenario, ChainSimulation, Options};
use trench_formation::trench::Hyperbolic;
use trench_formation::zoning::{Edge, ObstaclePotential, Radii, Sharpness, Zoning};

const CAPABILITY: Capability = Capability { speed: 1.2, acceleration: 5.0 };
/// Largest forces of trench, zones and obstacles: together what the robots can do. Obstacles outweigh the others by so much that
/// within a metre they stop a robot at full speed.
const LARGEST: [f64; 3] = [1.0, 1.0, 3.0];

/// 7.10 for robots of 1.2 m/s and 5 m/s^2, which the printed forces (10 m/s^2 and more) are far beyond.
fn bounded() -> ChainScenario<Hyperbolic> {
    let [trench, zones, obstacles] = LARGEST;
    let radii = Radii::new(1.0, 4.0, 10.0, 13.0, 30.0).unwrap();
    ChainScenario {
        law: NearestAttraction { trench: Hyperbolic { alpha: trench, a: 1.0 }, damping: 0.5, leader_damping: 1.0 },
        zoning: Zoning::new(radii, (10.0, 10.0), Sharpness::Two, Edge::Continuous, zones).unwrap(),
        potential: ObstaclePotential::new(2.0, 3.0, 10.0, Sharpness::Two, Edge::Continuous, obstacles).unwrap(),
        options: Options { limits: Some(CAPABILITY), ..Options::default() },
        ..chain_of_7_10(5.0)
    }
}

#[test]
fn what_the_law_may_want_at_most_fits() {
    assert!(CAPABILITY.fits(LARGEST));
}

/// One robot among the discs, damped so little that limits act for most of its way: V never rises.
#[test]
fn energy_falls_under_limits() {
    let mut scenario = bounded();
    scenario.robots.truncate(1);
    scenario.law.damping = 0.2;
    let mut simulation = ChainSimulation::new(scenario).unwrap();
    let (mut before, mut cut) = (f64::INFINITY, 0);
    for _ in 0..200_000 {
        simulation.step().unwrap();
        let action = simulation.outcomes()[0];
        cut += u32::from(action.cut);
        assert!(action.steered.lyapunov <= before + 1e-5, "{before} to {}", action.steered.lyapunov);
        assert!(action.acceleration.norm() <= CAPABILITY.acceleration + 1e-9);
        assert!(simulation.robots()[0].velocity.norm() <= CAPABILITY.speed + 1e-9);
        before = action.steered.lyapunov;
    }
    assert!(cut > 10_000, "{cut}");
    assert!(simulation.deviations()[0] < 0.1, "{:?}", simulation.deviations());
}

/// The whole chain: nobody in zone 1 or on a pole, all on the segment, speeds and accelerations within what robots can do.
#[test]
fn the_chain_of_7_10_within_limits() {
    let run = run(bounded());
    assert!(run.closest > 1.0, "{}", run.closest);
    assert!(run.nearest_obstacles.iter().all(|distance| *distance > 2.0), "{:?}", run.nearest_obstacles);
    assert!(run.robots.iter().all(|robot| robot.velocity.norm() <= CAPABILITY.speed + 1e-9));
    // Continuous edges: the attraction fades out at rho, to which followers come from outside.
    assert!(run.on_segment(0.1) && run.is_neutral(0.2), "{:?}", run.robots);
}
