//! Open queues (2.1) under the laws: beyond an open end the segment goes on for ever, with places, fragments and points of attraction.
#![expect(clippy::unwrap_used, reason = "a test may fail by a panic in a function of its own")]
use core::f64::consts::FRAC_PI_4;
use nalgebra::{Isometry2, Vector2};
use proptest::prelude::*;
use trench_formation::agent::{Agent, AgentSettings, Encroaching, Leader, Method, Surroundings};
use trench_formation::curve::{Curve, CurveShape, Placed, encroached};
use trench_formation::hull::{Obstacle, Outline, Shape, combine};
use trench_formation::kinematics::PointState;
use trench_formation::laws::{NearestAttraction, RigidMotion};
use trench_formation::seek::{Fragments, LeaderRule, SeekSettings};
use trench_formation::trench::Hyperbolic;
use trench_formation::zoning::{Edge, ObstaclePotential, Radii, Sharpness, Zoning};

const ENDLESS: f64 = f64::INFINITY;
/// Gap at which the potential of obstacles is cut, m.
const CUT: f64 = 0.5;

fn at(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

/// From (-20, 0) to (0, 0), and on from there.
fn queue() -> Curve {
    Curve::new(&CurveShape::Line(at(-20.0, 0.0), at(0.0, 0.0)), false, true).unwrap()
}

fn disc(id: u32, x: f64, radius: f64) -> Obstacle {
    Obstacle { id, shape: Shape::new(&[at(x, 0.0)], radius).unwrap() }
}

fn settings(method: Method, encroaching: Encroaching) -> AgentSettings<Hyperbolic> {
    let radii = Radii::new(0.5, 1.0, 5.0, 6.0, 60.0).unwrap();
    AgentSettings {
        law: NearestAttraction { trench: Hyperbolic { alpha: 2.0, a: 0.3 }, damping: 3.0, leader_damping: 0.0 },
        method,
        zoning: Zoning::new(radii, (0.5, 0.5), Sharpness::One, Edge::Continuous, 0.5).unwrap(),
        potential: ObstaclePotential::new(0.2, CUT, 0.5, Sharpness::Two, Edge::Continuous, 1.0).unwrap(),
        clearance: 0.1,
        seeking: SeekSettings {
            room: 0.5,
            transit_margin: 0.01,
            settled_distance: 0.1,
            settled_speed: 0.1,
            leader_rule: LeaderRule::StepSix,
        },
        encroaching,
        remedies: None,
        limits: None,
        sidesteps: false,
    }
}

/// The fragments of a robot that begins at rest at `start`, and where it is 40 s later. Its leader, if it has one, rests at a place of its own.
fn ends_at(
    settings: AgentSettings<Hyperbolic>,
    real: &[Obstacle],
    leader: Option<Vector2<f64>>,
    start: Vector2<f64>,
) -> (Vec<(f64, f64)>, Vector2<f64>) {
    let (curve, apparent) = (queue(), combine(real, settings.clearance).unwrap());
    let places: Vec<Vector2<f64>> = leader.into_iter().collect();
    let around = Surroundings {
        clear: 0.0,
        time: 0.0,
        curve: &curve,
        map_from_segment: Isometry2::identity(),
        motion: RigidMotion::at_rest(),
        goal: None,
        leader: leader.map(|leader| Leader { state: PointState::at_rest(leader), deviation: 0.0 }),
        places: &places,
        behind: 3,
        ahead: &[],
        real,
        apparent: &apparent,
        velocities: &[],
    };
    let mut agent = Agent::new(settings);
    agent.sense(&around).unwrap();
    let (mut robot, step) = (PointState::at_rest(start), 1e-3);
    for index in 0..40_000 {
        let action = agent.act(&around, robot, f64::from(index) * step, step);
        robot = robot.advanced_semi_implicit(action.acceleration, step);
    }
    (agent.fragments().to_vec(), robot.position)
}

fn check(
    settings: AgentSettings<Hyperbolic>,
    (real, leader): (&[Obstacle], Option<Vector2<f64>>),
    start: Vector2<f64>,
    (fragments, end): (&[(f64, f64)], Vector2<f64>),
) {
    let (found, last) = ends_at(settings, real, leader, start);
    let near = |(a, b): (&(f64, f64), &(f64, f64))| {
        let same = |a: f64, b: f64| a == b || (a - b).abs() < 1e-9;
        same(a.0, b.0) && same(a.1, b.1)
    };
    assert!(found.len() == fragments.len() && found.iter().zip(fragments).all(near), "{found:?}, not {fragments:?}");
    // The obstacle pushes a robot that comes by it a little along the queue.
    assert!((last - end).norm() < 0.1, "{last}, not {end}");
}

/// (7.4) and (7.13): the nearest point is abreast of the robot, not the vertex.
#[test]
fn a_robot_beyond_the_end_comes_to_the_extension() {
    for encroaching in [Encroaching::Nothing, Encroaching::Obstacles, Encroaching::ObstaclesAndRobots(0.5)] {
        let settings = settings(Method::Nearest, encroaching);
        check(settings, (&[], None), at(10.0, 5.0), (&[(0.0, ENDLESS)], at(10.0, 0.0)));
    }
}

/// One hull over all that the queue has of finite length, another on its extension: what is between and what is behind is left.
#[test]
fn obstacles_over_the_finite_part_leave_the_extension() {
    let wall = Obstacle { id: 1, shape: Shape::new(&[at(-21.0, 0.0), at(0.5, 0.0)], 0.5).unwrap() };
    let real = [wall, disc(2, 8.0, 1.0)];
    let fragments = [(20.0 + 1.0 + CUT, 28.0 - 1.0 - CUT), (28.0 + 1.0 + CUT, ENDLESS)];
    let seeks = || settings(Method::Nearest, Encroaching::Obstacles);
    check(seeks(), (&real, None), at(0.0, 4.0), (&fragments, at(1.5, 0.0)));
    check(seeks(), (&real, None), at(10.0, 5.0), (&fragments, at(10.0, 0.0)));
    check(seeks(), (&real, None), at(400.0, 5.0), (&fragments, at(400.0, 0.0)));
}

/// A robot that chooses a place from the start finds it within its leader's neutral zone, though that lies on the extension.
#[test]
fn places_are_chosen_on_the_extension() {
    let settings = settings(Method::Nearest, Encroaching::ObstaclesAndPlaces(0.5));
    let within = [(20.0 + 25.0, 20.0 + 29.0), (20.0 + 31.0, 20.0 + 35.0)];
    let (found, last) = ends_at(settings, &[], Some(at(30.0, 0.0)), at(34.0, 3.0));
    let near = |(a, b): (&(f64, f64), &(f64, f64))| (a.0 - b.0).abs() < 0.05 && (a.1 - b.1).abs() < 0.05;
    assert!(found.len() == 2 && found.iter().zip(&within).all(near), "{found:?}");
    assert!((last - at(34.0, 0.0)).norm() < 1e-3, "{last}");
}

/// (6.1): a direction meets the extension; one that meets nothing that is left draws to what it passes most closely, which is finite.
#[test]
fn directions_meet_the_extension() {
    let along =
        |angle: f64| Method::Directed { direction: Some(at(libm::cos(angle), libm::sin(angle))), compensates: true };
    let (start, leader) = (at(10.0, 5.0), Some(at(6.5, 4.0)));
    check(settings(along(FRAC_PI_4), Encroaching::Nothing), (&[], leader), start, (&[(0.0, ENDLESS)], at(5.0, 0.0)));
    // A disc takes the point that is met, (0.5, 0).
    let wall = [disc(1, 0.0, 1.0)];
    let fragments = [(0.0, 18.5), (21.5, ENDLESS)];
    let from = at(4.5, 4.0);
    check(
        settings(along(FRAC_PI_4), Encroaching::Obstacles),
        (&wall, Some(at(1.0, 3.0))),
        from,
        (&fragments, at(1.5, 0.0)),
    );
    // Parallel to the extension, which it never meets: the vertex is as near as any other point.
    let curve = queue();
    let met = Placed::new(&curve, Isometry2::identity()).attracting_along(start, at(1.0, 0.0), &[(0.0, ENDLESS)]);
    assert!(met.is_some_and(|(foot, is_met)| !is_met && foot.arc_length.is_finite() && foot.point.y == 0.0), "{met:?}");
}

#[test]
fn endless_fragments_have_places_for_all() {
    let groups = Fragments::beside(&queue(), (-ENDLESS, ENDLESS), &[(2.0, 4.0)], 0.5).groups(&queue(), 5.0, 1.0);
    assert_eq!(groups, [((-ENDLESS, ENDLESS), usize::MAX)]);
}

/// Numbers at which a millionth of a metre is lost in rounding come to an end, too.
#[test]
fn obstacles_far_away_are_found() {
    let (curve, far) = (queue(), [at(1e14, 0.0)]);
    let found = encroached(
        &Placed::new(&curve, Isometry2::identity()),
        curve.domain(),
        &[Outline { points: &far, radius: 0.5 }],
        0.5,
    );
    assert!(
        found.len() == 1 && (found[0].0 - 1e14 - 19.0).abs() < 0.1 && (found[0].1 - 1e14 - 21.0).abs() < 0.1,
        "{found:?}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// What a queue that is open at both ends loses to obstacles, for ever: nothing of it is cut off.
    #[test]
    fn encroachment_on_extensions_agrees_with_sampling(
        x in -12.0..12.0_f64, y in -3.0..3.0_f64, wide in 0.0..6.0_f64, turn in -3.0..3.0_f64, radius in 0.0..1.0_f64, reach in 0.1..2.0_f64,
    ) {
        let curve = Curve::new(&CurveShape::Polyline(vec![at(-1.0, 0.0), at(0.0, 0.5), at(1.0, 0.0)]), true, true).unwrap();
        let segment = Placed::new(&curve, Isometry2::new(at(0.3, -0.2), 0.4));
        let points = [at(x, y), at(x + wide * libm::cos(turn), y + wide * libm::sin(turn))];
        let outline = Outline { points: &points, radius };
        let found = encroached(&segment, curve.domain(), &[outline], reach);
        for index in -400..=400 {
            let s = 0.1 * f64::from(index);
            let gap = outline.approach(segment.at(s).point).gap - reach;
            let inside = found.iter().any(|(from, to)| *from <= s && s <= *to);
            prop_assert!(gap.abs() < 1e-6 || inside == (gap < 0.0), "{s} {gap} {found:?}");
        }
    }
}
