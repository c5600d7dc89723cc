//! Chapter 6: directions of attraction that are oblique, on curves, past ends, and within limits (6.3, A.12, 9.2).
#![expect(clippy::unwrap_used, reason = "a test may fail by a panic in a function of its own")]
use core::f64::consts::PI;
use nalgebra::{Isometry2, Vector2};
use proptest::prelude::*;
use trench_formation::agent::{Action, Agent, AgentSettings, Encroaching, Leader, Method, Surroundings};
use trench_formation::curve::{Curve, CurveShape};
use trench_formation::hull::{ApparentObstacle, Obstacle, Shape, combine};
use trench_formation::kinematics::PointState;
use trench_formation::laws::{Capability, NearestAttraction, RigidMotion};
use trench_formation::seek::{LeaderRule, SeekSettings};
use trench_formation::trench::Hyperbolic;
use trench_formation::zoning::{Edge, ObstaclePotential, Radii, Sharpness, Zoning};

/// Largest forces of trench and zones, m/s^2.
const TRENCH: f64 = 1.0;
const ZONES: f64 = 0.5;

fn at(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

fn towards(angle: f64) -> Vector2<f64> {
    let (sine, cosine) = libm::sincos(angle);
    at(cosine, sine)
}

/// Law (6.1) along a direction, within limits.
fn settings(direction: Vector2<f64>, damping: f64, limits: Option<Capability>) -> AgentSettings<Hyperbolic> {
    let radii = Radii::new(0.5, 1.0, 5.0, 6.0, 60.0).unwrap();
    AgentSettings {
        law: NearestAttraction { trench: Hyperbolic { alpha: TRENCH, a: 0.3 }, damping, leader_damping: 0.0 },
        method: Method::Directed { direction: Some(direction), compensates: true },
        zoning: Zoning::new(radii, (0.5, 0.5), Sharpness::One, Edge::Continuous, ZONES).unwrap(),
        potential: ObstaclePotential::new(0.2, 0.5, 0.5, Sharpness::Two, Edge::Continuous, 1.0).unwrap(),
        clearance: 0.1,
        seeking: SeekSettings {
            room: 0.0,
            transit_margin: 0.01,
            settled_distance: 0.1,
            settled_speed: 0.1,
            leader_rule: LeaderRule::StepSix,
        },
        encroaching: Encroaching::Obstacles,
        remedies: None,
        limits,
        sidesteps: false,
    }
}

/// What a robot with a resting leader sees of `curve` and of obstacles.
fn around<'a>(
    curve: &'a Curve,
    leader: Vector2<f64>,
    real: &'a [Obstacle],
    apparent: &'a [ApparentObstacle],
) -> Surroundings<'a> {
    Surroundings {
        clear: 0.0,
        time: 0.0,
        curve,
        map_from_segment: Isometry2::identity(),
        motion: RigidMotion::at_rest(),
        goal: None,
        leader: Some(Leader { state: PointState::at_rest(leader), deviation: 0.0 }),
        places: &[],
        behind: 0,
        ahead: &[],
        real,
        apparent,
        velocities: &[],
    }
}

/// Lets a robot go on for `duration` (s), and tells each action; where it ends.
fn drive(
    settings: AgentSettings<Hyperbolic>,
    around: &Surroundings<'_>,
    start: PointState,
    duration: f64,
    mut tell: impl FnMut(&Action, PointState),
) -> PointState {
    let step = 1e-3;
    let mut agent = Agent::new(settings);
    agent.sense(around).unwrap();
    let mut robot = start;
    for index in 0..(duration / step) as u32 {
        let action = agent.act(around, robot, f64::from(index) * step, step);
        tell(&action, robot);
        robot = robot.advanced_semi_implicit(action.acceleration, step);
    }
    robot
}

fn line(half: f64) -> Curve {
    Curve::new(&CurveShape::Line(at(-half, 0.0), at(half, 0.0)), false, false).unwrap()
}

/// What robots under an oblique direction need for the claim of 9.2: the trench pulls with Phi'/sin alpha across the segment.
fn enough(angle: f64) -> Capability {
    Capability { speed: 5.0, acceleration: TRENCH / libm::sin(angle) + ZONES }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// The claim of 9.2 for (6.1): V' <= 0 under limits that the potential forces fit, whatever the angle and however much damping is cut.
    #[test]
    fn energy_falls_along_oblique_directions_under_limits(
        x in -3.0..3.0_f64, y in -3.0..3.0_f64, heading in -PI..PI, speed in 0.0..2.0_f64, angle in 0.4..2.7_f64,
        damping in 0.1..20.0_f64, distance in 0.6..8.0_f64, bearing in -PI..PI,
    ) {
        let (curve, position) = (line(30.0), at(x, y));
        let around = around(&curve, position + distance * towards(bearing), &[], &[]);
        let limits = enough(angle);
        let mut agent = Agent::new(settings(towards(angle), damping, Some(limits)));
        agent.sense(&around).unwrap();
        let robot = PointState { position, velocity: speed * towards(heading) };
        let action = agent.act(&around, robot, 0.0, 1e-6);
        prop_assert!(action.acceleration.norm() <= limits.acceleration * (1.0 + 1e-9));
        let rate = action.steered.lyapunov_rate + action.cut_power;
        prop_assert!(rate <= 1e-9, "V' = {rate}, {action:?}");
    }
}

/// The same along whole runs, most of whose damping is cut.
#[test]
fn energy_never_rises_on_the_way() {
    for (angle, heading) in [(0.5, 0.0), (0.5, PI), (2.5, 0.0), (1.2, 1.0)] {
        let curve = line(60.0);
        let around = around(&curve, at(1.0, -3.0), &[], &[]);
        let start = PointState { position: at(0.0, 2.0), velocity: 3.0 * towards(heading) };
        let (mut before, mut cut) = (f64::INFINITY, 0);
        let end = drive(settings(towards(angle), 4.0, Some(enough(angle))), &around, start, 60.0, |action, robot| {
            cut += u32::from(action.cut);
            assert!(action.steered.lyapunov <= before + 1e-5, "{angle} {heading} {robot:?}: {before} to {action:?}");
            before = action.steered.lyapunov;
        });
        assert!(cut > 300 && end.position.y.abs() < 0.01, "{angle} {heading}: {cut} {end:?}");
    }
}

fn arc() -> Curve {
    let shape = CurveShape::Arc { centre: Vector2::zeros(), radius: 4.0, start_angle: 0.0, sweep: PI };
    Curve::new(&shape, false, false).unwrap()
}

/// On an arc the point of attraction is where the direction meets it, not its tangent at the nearest point; the law's V' is V's derivative,
/// and V falls.
#[test]
fn an_oblique_direction_on_an_arc() {
    let (curve, direction) = (arc(), towards(-1.2));
    let around = around(&curve, at(0.5, 3.5), &[], &[]);
    let start = PointState { position: at(-1.0, 7.0), velocity: at(0.5, 0.0) };
    let (mut before, mut rate, mut compared) = (f64::INFINITY, 0.0, 0);
    let end = drive(settings(direction, 2.0, None), &around, start, 30.0, |action, robot| {
        let point = action.attraction.unwrap();
        assert!((point.norm() - 4.0).abs() < 1e-9, "{point} is not on the arc");
        assert!(
            (point - robot.position).perp(&direction).abs() < 1e-9,
            "{point} is not in the direction from {robot:?}"
        );
        let value = action.steered.lyapunov;
        assert!(value <= before + 1e-6, "{before} to {value}");
        if before.is_finite() && robot.velocity.norm() > 0.1 {
            compared += 1;
            assert!(((value - before) / 1e-3 - rate).abs() < 0.02, "{} {rate}", (value - before) / 1e-3);
        }
        (before, rate) = (value, action.steered.lyapunov_rate);
    });
    assert!(compared > 1000 && (end.position.norm() - 4.0).abs() < 1e-3, "{compared} {end:?}");
}

/// Past the end a direction meets nothing: the end draws, and the robot comes to it.
#[test]
fn past_the_end_the_end_draws() {
    let curve = line(3.0);
    for (direction, start) in
        [(towards(1.0), at(5.0, 1.0)), (towards(-0.9), at(-4.0, -2.0)), (at(0.0, 1.0), at(3.5, 2.0))]
    {
        let around = around(&curve, at(0.0, 0.0), &[], &[]);
        let end = at(3.0 * start.x.signum(), 0.0);
        let mut before = f64::INFINITY;
        let last = drive(settings(direction, 3.0, None), &around, PointState::at_rest(start), 30.0, |action, robot| {
            let point = action.attraction.unwrap();
            assert!(point.x.abs() <= 3.0 + 1e-9 && point.y.abs() < 1e-9, "{point} is not on the segment");
            assert!((point - end).norm() < 1e-9 || (point.x - end.x).abs() < 0.1, "{robot:?} is drawn to {point}");
            assert!(action.steered.lyapunov <= before + 1e-6, "{robot:?}");
            before = action.steered.lyapunov;
        });
        assert!((last.position - end).norm() < 0.02, "{last:?}");
    }
}

/// What an obstacle takes of the segment draws nobody.
#[test]
fn a_direction_meets_qualified_fragments_alone() {
    let curve = line(6.0);
    let disc = [Obstacle { id: 1, shape: Shape::new(&[at(0.0, 0.0)], 0.5).unwrap() }];
    let apparent = combine(&disc, 0.1).unwrap();
    let around = around(&curve, at(3.0, 0.5), &disc, &apparent);
    let start = PointState::at_rest(at(-1.5, 2.0));
    // Along the direction the segment is met at (0.3, 0), in the disc.
    let end = drive(settings(at(1.8, -2.0).normalize(), 3.0, None), &around, start, 30.0, |action, _| {
        assert!(action.attraction.unwrap().x.abs() >= 1.0 - 1e-6, "{action:?}");
    });
    assert!(end.position.y.abs() < 0.01 && end.position.x.abs() > 0.99, "{end:?}");
}
