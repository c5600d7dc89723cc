//! Chapter 7: where the attraction is suspended (Remark 6.4.1, 7.7), and where nothing of the segment is left to draw anybody (7.5.2).
#![expect(clippy::unwrap_used, reason = "a test may fail by a panic in a function of its own")]
#[path = "chapter7/chain.rs"]
mod chain;

use chain::chain_of_7_10;
use trench_formation::Vector2;
use trench_formation::agent::{Agent, RemedyState, Surroundings};
use trench_formation::avoidance::WatchSettings;
use trench_formation::curve::{Curve, CurveShape};
use trench_formation::hull::{Obstacle, Shape, combine};
use trench_formation::kinematics::PointState;
use trench_formation::laws::{GoalMotion, RigidMotion};
use trench_formation::simulate::{
    ChainScenario, ChainSimulation, Encroaching, Options, Remedies, Standard, Verdict, judge,
};
use trench_formation::trench::Hyperbolic;
use trench_formation::zoning::{Edge, ObstaclePotential, Sharpness};

fn at(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

fn line(from: Vector2<f64>, to: Vector2<f64>) -> Curve {
    Curve::new(&CurveShape::Line(from, to), false, false).unwrap()
}

/// One robot at rest, with remedies.
fn alone(start: Vector2<f64>, obstacles: Vec<Obstacle>) -> ChainScenario<Hyperbolic> {
    let watch = WatchSettings { radius: 0.1, patience: 1.0, arrived: 0.05 };
    ChainScenario {
        segment: line(at(-20.0, -3.0), at(20.0, -3.0)),
        team_goal: None,
        robots: vec![PointState::at_rest(start)],
        obstacles,
        clearance: 5.0,
        potential: ObstaclePotential::new(0.0, 1.0, 10.0, Sharpness::Two, Edge::Continuous, 1e4).unwrap(),
        encroaching: Encroaching::Obstacles,
        remedies: Some(Remedies { watch, rising: 0.5 }),
        ..chain_of_7_10(5.0)
    }
}

/// Runs the robot for `duration` (s) and tells each state with what is done about it; `goal` draws it if there is one.
fn run(
    scenario: &ChainScenario<Hyperbolic>,
    goal: Option<Vector2<f64>>,
    duration: f64,
    mut tell: impl FnMut(RemedyState, Option<Vector2<f64>>, PointState),
) {
    let apparent = combine(&scenario.obstacles, scenario.clearance).unwrap();
    let mut around = Surroundings {
        clear: 0.0,
        time: 0.0,
        curve: &scenario.segment,
        map_from_segment: nalgebra::Isometry2::identity(),
        motion: RigidMotion::at_rest(),
        goal: goal.map(GoalMotion::at_rest),
        leader: None,
        places: &[],
        behind: 0,
        ahead: &[],
        real: &scenario.obstacles,
        apparent: &apparent,
        velocities: &[],
    };
    let mut agent = Agent::new(scenario.agent());
    let mut robot = scenario.robots[0];
    agent.sense(&around).unwrap();
    for index in 0..(duration / scenario.step) as u32 {
        around.time = f64::from(index) * scenario.step;
        let action = agent.act(&around, robot, 0.0, scenario.step);
        robot = robot.advanced_semi_implicit(action.acceleration, scenario.step);
        tell(action.remedy, action.attraction, robot);
    }
}

fn wall(id: u32, from: Vector2<f64>, to: Vector2<f64>) -> Obstacle {
    Obstacle { id, shape: Shape::new(&[from, to], 0.0).unwrap() }
}

/// A hull that encloses the robot and walls that leave no way out: the attraction is off, the members repel, the hull does not, and the
/// robot comes to rest where it is shut in.
#[test]
fn without_a_way_out_the_attraction_is_off() {
    let corners = [at(0.0, 0.0), at(6.0, 0.0), at(6.0, 4.0), at(0.0, 4.0)];
    let walls: Vec<Obstacle> =
        (0..4).map(|side| wall(side, corners[side as usize], corners[(side as usize + 1) % 4])).collect();
    let scenario = alone(at(1.5, 0.6), walls);
    let (mut suspended, mut steps, mut last) = (0, 0, scenario.robots[0]);
    run(&scenario, None, 20.0, |remedy, attraction, robot| {
        steps += 1;
        suspended += u32::from(remedy == RemedyState::Suspended && attraction.is_none());
        assert!(robot.position.x > 0.1 && robot.position.x < 5.9, "{remedy:?} {robot:?}");
        assert!(robot.position.y > 0.1 && robot.position.y < 3.9, "{remedy:?} {robot:?}");
        assert!(robot.velocity.norm() < 5.0, "thrown: {remedy:?} {robot:?}");
        last = robot;
    });
    assert!(suspended == steps, "{suspended} of {steps}");
    assert!(last.velocity.norm() < 1e-3, "{last:?}");
}

/// A goal point within an obstacle: no guard can be drawn and no way leads there. The attraction rests for a while, comes back, and
/// rests again; the robot stays before the obstacle.
#[test]
fn where_neither_guard_nor_way_helps_the_attraction_rests() {
    let disc = Obstacle { id: 3, shape: Shape::new(&[at(0.0, 0.0)], 2.0).unwrap() };
    let scenario = alone(at(8.0, 1.0), vec![disc]);
    let (mut began, mut before, mut led) = (0, RemedyState::None, 0);
    run(&scenario, Some(at(0.3, 0.1)), 40.0, |remedy, attraction, robot| {
        began += u32::from(remedy == RemedyState::Suspended && before != RemedyState::Suspended);
        led += u32::from(remedy == RemedyState::Led);
        assert_eq!(attraction.is_none(), remedy == RemedyState::Suspended);
        assert!(robot.position.norm() > 2.05 && robot.position.norm() < 8.5, "{robot:?}");
        before = remedy;
    });
    assert!(began >= 2 && led == 0, "{began} {led}");
}

/// A segment of 2 m that a moving disc comes to cover: the robot stood on it.
fn covered() -> ChainScenario<Hyperbolic> {
    ChainScenario {
        segment: line(at(0.0, 0.0), at(2.0, 0.0)),
        obstacles: vec![Obstacle { id: 1, shape: Shape::new(&[at(20.0, 0.0)], 3.0).unwrap() }],
        options: Options { obstacle_velocities: vec![at(-0.5, 0.0)], ..Options::default() },
        remedies: None,
        step: 0.01,
        ..alone(at(1.0, 1.0), Vec::new())
    }
}

/// Whom no fragment is left for does not conform, however near to one it was before.
#[test]
fn a_robot_whose_last_fragment_is_gone_does_not_conform() {
    let mut simulation = ChainSimulation::new(covered()).unwrap();
    while simulation.time() < 10.0 {
        simulation.step().unwrap();
    }
    assert!(simulation.deviations()[0] < 0.05, "{:?}", simulation.deviations());
    while simulation.time() < 38.0 {
        simulation.step().unwrap();
    }
    assert!(simulation.fragments(1).is_empty(), "{:?}", simulation.fragments(1));
    assert!(simulation.deviations()[0].is_infinite(), "{:?}", simulation.deviations());
}

/// And a run is not judged to conform by what was true before: the disc is there before the robot has stood for long enough.
#[test]
fn a_team_without_fragments_is_late() {
    let capability = trench_formation::laws::Capability { speed: 5.0, acceleration: 100.0 };
    let standard = Standard { body_radius: 0.1, capability, tolerance: 0.5 };
    let mut scenario = covered();
    // The whole segment is covered from 3 s on, and the disc is slow then: it passes for minutes.
    scenario.obstacles = vec![Obstacle { id: 1, shape: Shape::new(&[at(0.0, -4.2)], 3.0).unwrap() }];
    scenario.options.obstacle_velocities = vec![at(0.0, 0.25)];
    let verdict = judge(scenario, &standard).unwrap();
    assert!(matches!(verdict, Verdict::Late(1, deviation) if deviation.is_infinite()), "{verdict:?}");
}
