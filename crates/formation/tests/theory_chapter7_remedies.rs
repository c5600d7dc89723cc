//! Chapter 7: local minima and the ways out (7.6, 7.7).
#![expect(clippy::unwrap_used, reason = "a test may fail by a panic in a function of its own")]
use nalgebra::Isometry2;
use trench_formation::Vector2;
use trench_formation::avoidance::{Guard, WatchSettings, auxiliary_arc, auxiliary_lines, escape};
use trench_formation::curve::{Curve, CurveShape, Placed};
use trench_formation::hull::{Obstacle, Outline, Shape};
use trench_formation::kinematics::PointState;
use trench_formation::laws::{Attracting, GoalMotion, NearestAttraction, Push};
use trench_formation::seek::{LeaderRule, SeekSettings};
use trench_formation::simulate::{Carriage, ChainScenario, ChainSimulation, Encroaching, Options, Remedies};
use trench_formation::trench::Hyperbolic;
use trench_formation::zoning::{Edge, ObstaclePotential, Radii, Sharpness, Zoning};

fn at(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

fn points<const N: usize>(corners: [[f64; 2]; N]) -> Vec<Vector2<f64>> {
    corners.map(Vector2::from).to_vec()
}

const LAW: NearestAttraction<Hyperbolic> =
    NearestAttraction { trench: Hyperbolic { alpha: 10.0, a: 1.0 }, damping: 5.0, leader_damping: 0.0 };

fn potential() -> ObstaclePotential {
    ObstaclePotential::new(0.0, 1.0, 10.0, Sharpness::Two, Edge::Jump, 1e4).unwrap()
}

/// Where a robot ends after 60 s with a guard that is there from the start.
fn drive(segment: &CurveShape, outline: &Outline<'_>, start: Vector2<f64>, guard: Option<Guard>) -> Vector2<f64> {
    let curve = Curve::new(segment, false, false).unwrap();
    let segment = Placed::new(&curve, Isometry2::identity());
    let mut robot = PointState::at_rest(start);
    for _ in 0..60_000 {
        let foot = segment.nearest(robot.position);
        let approach = match &guard {
            Some(guard) => guard.approach(outline, robot.position),
            None => outline.approach(robot.position),
        };
        let attracting = Attracting { foot: GoalMotion::at_rest(foot.point), draws: true };
        let steered = LAW.steer(robot, attracting, None, [Push::of_obstacle(&potential(), approach)]);
        robot = robot.advanced_semi_implicit(steered.acceleration, 1e-3);
    }
    robot.position
}

fn fig_7_11() -> (CurveShape, Vec<Vector2<f64>>) {
    (CurveShape::Line(at(-20.0, 0.0), at(20.0, 0.0)), points([[-3.0, 2.0], [3.0, 2.0], [3.0, 4.0], [-3.0, 4.0]]))
}

#[test]
fn the_arc_of_fig_7_12() {
    let (segment, rectangle) = fig_7_11();
    let outline = Outline { points: &rectangle, radius: 0.0 };
    let stuck = drive(&segment, &outline, at(1.0, 9.0), None);
    assert!((stuck - at(1.0, 5.005)).norm() < 0.01, "{stuck}");

    let curve = Curve::new(&segment, false, false).unwrap();
    let foot = Placed::new(&curve, Isometry2::identity()).nearest(stuck);
    let guard = auxiliary_arc(&outline, stuck, &foot).unwrap();
    assert!(guard.centre.norm() < 1e-12 && (guard.ends[0].norm() - 5.0).abs() < 1e-12, "{guard:?}");
    for start in [at(1.0, 9.0), at(0.0, 9.0), at(-2.5, 7.0)] {
        let end = drive(&segment, &outline, start, Some(guard));
        assert!(end.y.abs() < 1e-6 && end.x.abs() > 3.0, "from {start} to {end}");
    }
}

/// A bow about P0, the end of the segment, as a polygon of many corners.
fn fig_7_13() -> (CurveShape, Vec<Vector2<f64>>) {
    let corner = |index: i32| {
        let (sine, cosine) = libm::sincos(std::f64::consts::FRAC_PI_2 + f64::from(index) * 0.01);
        at(4.0 * cosine, 4.0 * sine)
    };
    let inner = [corner(-60), corner(60)].map(|corner| corner * 0.75);
    let shape =
        Shape::new(&[(-60..=60).map(corner).collect::<Vec<_>>(), vec![inner[1], inner[0]]].concat(), 0.0).unwrap();
    (CurveShape::Line(at(0.0, -6.0), at(0.0, 0.0)), shape.outline().points.to_vec())
}

#[test]
fn the_lines_of_fig_7_13() {
    let (segment, bow) = fig_7_13();
    let outline = Outline { points: &bow, radius: 0.0 };
    let stuck = drive(&segment, &outline, at(1.0, 8.0), None);
    assert!(stuck.norm() > 4.9, "{stuck}");
    let guard = auxiliary_lines(&outline, stuck, at(0.0, 0.0)).unwrap();
    for start in [at(1.0, 8.0), at(0.0, 8.0), at(-3.0, 6.0), 8.0 * guard.ends[1].normalize()] {
        let end = drive(&segment, &outline, start, Some(guard));
        assert!(end.x.abs() < 1e-6 && end.y < 1e-6, "from {start} to {end}");
    }
}

/// ERRATA: with the printed right angles a robot rests on the ray from P0 through P2.
#[test]
fn right_angles_leave_an_equilibrium() {
    let (segment, bow) = fig_7_13();
    let outline = Outline { points: &bow, radius: 0.0 };
    let guard = auxiliary_lines(&outline, at(1.0, 8.0), at(0.0, 0.0)).unwrap();
    let [first, second] = guard.ends;
    let middle = (first + second).normalize();
    let printed = Guard { apex: Some(middle * (16.0 / first.dot(&middle))), ..guard };
    let end = drive(&segment, &outline, 8.0 * second.normalize(), Some(printed));
    assert!(end.norm() > 4.9, "{end}");
}

/// The same by the simulation, which has to notice by itself.
#[test]
fn the_simulation_frees_a_caught_robot() {
    let check = |(segment, corners): (CurveShape, Vec<Vector2<f64>>), start, remedies, through: bool| {
        let radii = Radii::new(1.0, 4.0, 10.0, 13.0, 30.0).unwrap();
        let scenario = ChainScenario {
            segment: Curve::new(&segment, false, false).unwrap(),
            carriage: Carriage::parked(),
            team_goal: None,
            robots: vec![PointState::at_rest(start)],
            law: LAW,
            zoning: Zoning::new(radii, (10.0, 10.0), Sharpness::Two, Edge::Jump, 1e4).unwrap(),
            obstacles: vec![Obstacle { id: 1, shape: Shape::new(&corners, 0.0).unwrap() }],
            clearance: 1.0,
            potential: potential(),
            seeking: SeekSettings {
                room: 0.0,
                transit_margin: 1e-3,
                settled_distance: 0.05,
                settled_speed: 0.05,
                leader_rule: LeaderRule::StepSix,
            },
            encroaching: Encroaching::Obstacles,
            remedies,
            options: Options::default(),
            step: 0.001,
            steps_per_tick: 1,
        };
        let mut simulation = ChainSimulation::new(scenario).unwrap();
        let mut fastest: f64 = 0.0;
        for _ in 0..60_000 {
            simulation.step().unwrap();
            fastest = fastest.max(simulation.robots()[0].velocity.norm());
        }
        assert_eq!(simulation.deviations()[0] < 1e-6, through, "{:?}", simulation.robots());
        assert!(fastest < 4.0, "a guard must not throw the robot: {fastest}");
    };
    let watch = WatchSettings { radius: 0.1, patience: 1.0, arrived: 0.05 };
    let remedies = Some(Remedies { watch, rising: 0.5 });
    for start in [at(1.0, 9.0), at(0.0, 9.0)] {
        check(fig_7_11(), start, None, false);
        check(fig_7_11(), start, remedies, true);
        check(fig_7_13(), start, None, false);
        check(fig_7_13(), start, remedies, true);
    }
}

/// Fig. 7.14: the nearest point outside the hull lies behind the wall of a member; the way out is the mouth of the bay.
#[test]
fn escape_by_the_open_side() {
    let bay = [[[0.0, 0.0], [0.0, 4.0]], [[0.0, 0.0], [6.0, 0.0]], [[0.0, 4.0], [6.0, 4.0]]].map(points);
    let hull = points([[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0]]);
    let hull = Outline { points: &hull, radius: 0.0 };
    let walls: Vec<Outline<'_>> = bay.iter().map(|points| Outline { points, radius: 0.0 }).collect();
    let robot = at(1.0, 1.0);
    let way = escape(&hull, &walls, robot, 0.2, 0.5).unwrap();
    let end = *way.last().unwrap();
    assert!(hull.approach(end).gap >= 0.5 && end.x > 6.0, "{way:?}");
    for pair in [&[robot][..], &way].concat().windows(2) {
        for step in 0..=100 {
            let point = pair[0] + (pair[1] - pair[0]) * (f64::from(step) / 100.0);
            assert!(walls.iter().all(|wall| wall.approach(point).gap > 0.19), "{point}");
        }
    }
    let lid = points([[6.0, 0.0], [6.0, 4.0]]);
    let closed = [walls, vec![Outline { points: &lid, radius: 0.0 }]].concat();
    assert_eq!(escape(&hull, &closed, robot, 0.2, 0.5), None);
    assert_eq!(escape(&hull, &closed, at(8.0, 1.0), 0.2, 0.5), Some(Vec::new()), "already out");
}
