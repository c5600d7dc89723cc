//! Runs do not depend on the number of threads, and what is out of reach is not looked at.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#[path = "chapter7/chain.rs"]
mod chain;
mod threads;

use chain::chain_of_7_10;
use nalgebra::Vector2;
use threads::Threads;
use trench_formation::avoidance::WatchSettings;
use trench_formation::curve::{Curve, CurveShape};
use trench_formation::hull::{Obstacle, Shape};
use trench_formation::kinematics::PointState;
use trench_formation::laws::Capability;
use trench_formation::safety::Stopping;
use trench_formation::simulate::{ChainScenario, ChainSimulation, Encroaching, Options, Remedies};
use trench_formation::trench::Hyperbolic;
use trench_formation::zoning::{Edge, ObstaclePotential, Sharpness};

/// Shares have 128 robots at least: these are worth five.
const ROBOTS: u32 = 650;

/// 7.10's law and discs for many robots in two rows beside a long segment.
fn many() -> ChainScenario<Hyperbolic> {
    let line = CurveShape::Line(Vector2::new(0.0, 0.0), Vector2::new(3000.0, 0.0));
    let place =
        |rank: u32| Vector2::new(2990.0 - 4.5 * f64::from(rank), if rank.is_multiple_of(2) { 5.0 } else { -3.0 });
    let capability = Capability { speed: 3.0, acceleration: 40.0 };
    ChainScenario {
        segment: Curve::new(&line, false, false).unwrap(),
        team_goal: Some(Vector2::new(3000.0, 0.0)),
        robots: (0..ROBOTS).map(|rank| PointState::at_rest(place(rank))).collect(),
        options: Options {
            limits: Some(capability),
            safety: Some(Stopping { radius: 0.3, capability }),
            ..Options::default()
        },
        step: 0.01,
        steps_per_tick: 3,
        ..chain_of_7_10(5.0)
    }
}

fn end(simulation: ChainSimulation<Hyperbolic>) -> Vec<PointState> {
    let mut simulation = simulation;
    (0..400).for_each(|_| simulation.step().unwrap());
    simulation.robots().to_vec()
}

#[test]
fn one_thread_or_several() {
    let run = |threads| end(ChainSimulation::new(many()).unwrap().with(Threads(threads)));
    let alone = run(1);
    assert_eq!(alone, run(2));
    // Each of the five has 130.
    assert_eq!(alone, run(5));
    assert!(alone.iter().all(|robot| robot.position.y.abs() < 3.0), "they are on their way to the segment");
}

/// The same where obstacles rest before some robots and move across the way of others, and robots that are caught have remedies.
fn among_obstacles(remedies: bool) -> ChainScenario<Hyperbolic> {
    let mut scenario = many();
    // Before every fortieth robot of the upper row a wall that is too wide to slide off; every other one moves along with the segment.
    let middles = (0..8).map(|index| Vector2::new(2990.0 - 4.5 * f64::from(80 * index + 20), 2.2));
    let wall = |(id, middle): (u32, Vector2<f64>)| {
        let half = Vector2::new(4.0, 0.0);
        Obstacle { id, shape: Shape::new(&[middle - half, middle + half], 0.1).unwrap() }
    };
    scenario.obstacles = (0..).zip(middles).map(wall).collect();
    let velocity = |index: u32| Vector2::new(if index.is_multiple_of(2) { 0.0 } else { 0.4 }, 0.0);
    scenario.options.obstacle_velocities = (0..8).map(velocity).collect();
    scenario.options.sidesteps = true;
    scenario.potential = ObstaclePotential::new(0.3, 1.0, 2.0, Sharpness::Two, Edge::Continuous, 30.0).unwrap();
    scenario.encroaching = Encroaching::Obstacles;
    let watch = WatchSettings { radius: 0.3, patience: 0.5, arrived: 0.1 };
    scenario.remedies = remedies.then_some(Remedies { watch, rising: 1.0 });
    scenario
}

#[test]
fn one_thread_or_several_with_remedies_and_moving_obstacles() {
    let run = |remedies, threads| end(ChainSimulation::new(among_obstacles(remedies)).unwrap().with(Threads(threads)));
    let alone = run(true, 1);
    assert_eq!(alone, run(true, 2));
    assert_eq!(alone, run(true, 5));
    assert_ne!(alone, run(false, 5), "somebody was caught");
}

/// A winding segment, robots of which most have nothing but their leader near: these are steered several at once.
fn winding(open_end: bool) -> ChainScenario<Hyperbolic> {
    let (origin, amplitude, wavelength) = (Vector2::zeros(), 9.0, 120.0);
    let shape = CurveShape::Sinusoid { origin, direction: 0.3, length: 1600.0, amplitude, wavelength, phase: 1.0 };
    let segment = Curve::new(&shape, false, open_end).unwrap();
    let place = |rank: u32| {
        let foot = segment.at(1400.0 - 4.5 * f64::from(rank));
        foot.point + (f64::from(rank * 7 % 11) - 5.0) * Vector2::new(-foot.tangent.y, foot.tangent.x)
    };
    let robots = (0..301).map(|rank| PointState::at_rest(place(rank))).collect();
    ChainScenario { robots, team_goal: Some(place(0)), segment, steps_per_tick: 1, ..many() }
}

/// An open end changes nothing for robots that are far from it, but that their nearest points are sought one by one; and on other numbers
/// of threads others stand side by side.
#[test]
fn alone_or_side_by_side() {
    let run = |open_end, threads| end(ChainSimulation::new(winding(open_end)).unwrap().with(Threads(threads)));
    let side_by_side = run(false, 1);
    assert_eq!(side_by_side, run(true, 1));
    assert_eq!(side_by_side, run(false, 2));
}
