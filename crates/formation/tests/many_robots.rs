//! Runs do not depend on the number of threads, and what is out of reach is not looked at.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#[path = "chapter7/chain.rs"]
mod chain;
mod threads;

use chain::chain_of_7_10;
use nalgebra::Vector2;
use threads::Threads;
use trench_formation::agent::{Agent, Leader, Surroundings};
use trench_formation::avoidance::WatchSettings;
use trench_formation::curve::{Curve, CurveShape};
use trench_formation::hull::{Obstacle, Shape, combine};
use trench_formation::kinematics::PointState;
use trench_formation::laws::{Capability, RigidMotion};
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

/// Where robots encroach, each looks into what the one ahead has found: it finds what it would find alone, at rest and under way.
#[test]
fn robots_that_seek_one_after_the_other_find_what_each_finds_alone() {
    let place = |rank: u32| 70.0 - 1.7 * f64::from(rank);
    let start = |rank: u32| PointState {
        position: Vector2::new(place(rank), place(rank) + 0.4 * f64::from(rank % 5)),
        velocity: Vector2::new(5.0 - 0.1 * f64::from(rank), 2.0),
    };
    let scenario = ChainScenario {
        robots: (0..40).map(start).collect(),
        encroaching: Encroaching::ObstaclesAndRobots(0.3),
        ..many_discs()
    };
    let apparent = combine(&scenario.obstacles, scenario.clearance).unwrap();
    let mut simulation = ChainSimulation::new(scenario.clone()).unwrap();
    let mut different = 0;
    for _ in 0..3 {
        let robots = simulation.robots().to_vec();
        simulation.step().unwrap();
        for index in 0..robots.len() {
            let leader = index.checked_sub(1);
            let around = Surroundings {
                time: 0.0,
                curve: &scenario.segment,
                map_from_segment: nalgebra::Isometry2::identity(),
                motion: RigidMotion::at_rest(),
                goal: None,
                leader: leader.map(|leader| Leader { state: robots[leader], deviation: f64::INFINITY }),
                ahead: &robots[..leader.unwrap_or(0)],
                places: &[],
                behind: robots.len() - index - 1,
                real: &scenario.obstacles,
                apparent: &apparent,
                velocities: &[],
                clear: 0.0,
            };
            let mut alone = Agent::new(scenario.agent());
            alone.sense(&around).unwrap();
            assert_eq!(alone.fragments(), simulation.fragments(index + 1), "r{}", index + 1);
            different +=
                usize::from(leader.is_some_and(|leader| simulation.fragments(leader + 1) != alone.fragments()));
        }
    }
    assert!(different > 60, "what is left changes with the rank: {different}");
}

/// 7.10 among its discs, a tick each step.
fn many_discs() -> ChainScenario<Hyperbolic> {
    ChainScenario { clearance: 1.0, step: 0.01, steps_per_tick: 1, ..chain_of_7_10(5.0) }
}
