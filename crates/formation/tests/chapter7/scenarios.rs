//! Scenarios besides 7.10.
use super::chain_of_7_10;
use trench_formation::Vector2;
use trench_formation::avoidance::WatchSettings;
use trench_formation::curve::{Curve, CurveShape};
use trench_formation::hull::{Obstacle, Shape};
use trench_formation::kinematics::PointState;
use trench_formation::simulate::{Carriage, ChainScenario, ChainSimulation, Encroaching, Remedies};
use trench_formation::trench::Hyperbolic;
use trench_formation::zoning::{Edge, ObstaclePotential, Sharpness};

fn at(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

/// A segment that moves and turns is followed: the chain leader's goal point exactly, by feedforward.
#[test]
fn a_segment_under_way() {
    let segment = Curve::new(&CurveShape::Line(at(-20.0, 0.0), at(0.0, 0.0)), false, false).unwrap();
    let carriage = Carriage { origin: at(30.0, 30.0), heading: 0.8, velocity: at(0.5, 0.3), turn_rate: 0.02 };
    let mut simulation = ChainSimulation::new(ChainScenario {
        segment,
        carriage,
        team_goal: Some(at(0.0, 0.0)),
        robots: chain_of_7_10(5.0).robots[..3].to_vec(),
        obstacles: Vec::new(),
        encroaching: Encroaching::Nothing,
        ..chain_of_7_10(5.0)
    })
    .unwrap();
    (0..100_000).for_each(|_| simulation.step().unwrap());
    let deviations = simulation.deviations();
    assert!(deviations[0] < 2e-3, "{deviations:?}");
    assert!(deviations.iter().all(|deviation| *deviation < 0.05), "{deviations:?}");
    let distances = simulation.robots().windows(2).map(|pair| (pair[0].position - pair[1].position).norm());
    assert!(distances.clone().all(|distance| (4.0..10.0).contains(&distance)), "{:?}", distances.collect::<Vec<_>>());
}

fn check(change: impl Fn(&mut ChainScenario<Hyperbolic>), expected: &str) {
    let mut scenario = chain_of_7_10(5.0);
    change(&mut scenario);
    let text = ChainSimulation::new(scenario).map(|_| ()).map_err(|error| error.to_string());
    assert!(text.clone().is_err_and(|text| text.contains(expected)), "{text:?}");
}

#[test]
fn refused_scenarios() {
    check(|scenario| scenario.robots.clear(), "no robots");
    check(|scenario| scenario.robots[3].position.x = f64::NAN, "r4 is not finite");
    check(|scenario| scenario.robots[4].position = scenario.robots[2].position, "r3 and r5 start 0 m apart");
    check(|scenario| scenario.step = 0.0, "step is 0 s");
    check(|scenario| scenario.steps_per_tick = 0, "steps_per_tick is 0");
    check(|scenario| scenario.team_goal = Some(at(f64::INFINITY, 0.0)), "the team goal is not finite");
    check(|scenario| scenario.seeking.settled_speed = 0.0, "settled_speed is 0; it must be finite and positive");
    check(|scenario| scenario.carriage.heading = f64::NAN, "motion of the segment");
    check(|scenario| scenario.obstacles[1].id = 0, "two obstacles have the id 0");
    let trapped = |scenario: &mut ChainScenario<Hyperbolic>| {
        scenario.obstacles[2].shape = Shape::new(&[at(26.0, 29.0)], 1.0).unwrap();
    };
    check(trapped, "r1 starts inside obstacle 2");
}

/// Step (1) in full: robots ahead encroach on the segment, so a nearest point is never beside one of them.
#[test]
fn robots_ahead_encroach() {
    let mut simulation = ChainSimulation::new(ChainScenario {
        robots: chain_of_7_10(5.0).robots[..4].to_vec(),
        encroaching: Encroaching::ObstaclesAndRobots(1.0),
        steps_per_tick: 100,
        ..chain_of_7_10(5.0)
    })
    .unwrap();
    let mut closest = f64::INFINITY;
    for _ in 0..30_000 {
        simulation.step().unwrap();
        closest = closest.min(simulation.least_distance());
    }
    assert!(closest > 3.5, "{closest}");
    let mut looked_at = 0;
    for (index, robot) in simulation.robots().iter().enumerate() {
        let [x, y] = [robot.position.x, robot.position.y];
        let on_segment = (0.5 * (x + y) + 5.0) * core::f64::consts::SQRT_2;
        for rank in (index + 2..=4).filter(|_| (x - y).abs() < 1.0) {
            let free = |(from, to): &(f64, f64)| *from < on_segment + 3.0 && on_segment - 3.0 < *to;
            assert!(!simulation.fragments(rank).iter().any(free), "r{} stands on a fragment of r{rank}", index + 1);
            looked_at += 1;
        }
    }
    assert!(looked_at > 0);
}

/// 7.7: a bay of three walls, combined; the robot in it is led out by the mouth, round the walls, to the segment behind them.
#[test]
fn out_of_a_bay() {
    let wall = |id, from, to| Obstacle { id, shape: Shape::new(&[from, to], 0.0).unwrap() };
    let obstacles = vec![
        wall(1, at(0.0, 0.0), at(0.0, 4.0)),
        wall(2, at(0.0, 0.0), at(6.0, 0.0)),
        wall(3, at(0.0, 4.0), at(6.0, 4.0)),
    ];
    let watch = WatchSettings { radius: 0.1, patience: 1.0, arrived: 0.05 };
    let scenario = ChainScenario {
        segment: Curve::new(&CurveShape::Line(at(-20.0, -3.0), at(20.0, -3.0)), false, false).unwrap(),
        team_goal: None,
        robots: vec![PointState::at_rest(at(1.0, 1.5))],
        obstacles: obstacles.clone(),
        clearance: 5.0,
        potential: ObstaclePotential::new(0.0, 1.0, 10.0, Sharpness::Two, Edge::Continuous, 1e4).unwrap(),
        encroaching: Encroaching::Obstacles,
        remedies: Some(Remedies { watch, rising: 0.5 }),
        ..chain_of_7_10(5.0)
    };
    let mut simulation = ChainSimulation::new(scenario).unwrap();
    assert_eq!(simulation.obstacles().len(), 1);
    let mut least = f64::INFINITY;
    for _ in 0..60_000 {
        simulation.step().unwrap();
        let gap = |obstacle: &Obstacle| obstacle.shape.outline().approach(simulation.robots()[0].position).gap;
        least = obstacles.iter().map(gap).fold(least, f64::min);
    }
    assert!(simulation.deviations()[0] < 1e-6, "{:?}", simulation.robots());
    assert!(simulation.robots()[0].position.x > 6.0 && least > 0.3, "{least} {:?}", simulation.robots());
}
