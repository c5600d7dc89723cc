//! What moves around a robot brings power into its Lyapunov function: the law's own rate and those powers are its derivative.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]
use nalgebra::{Isometry2, Vector2};
use proptest::prelude::*;
use trench_formation::agent::{Agent, AgentSettings, Encroaching, Leader, Method, Surroundings};
use trench_formation::curve::{Curve, CurveShape};
use trench_formation::hull::{Obstacle, Shape, combine};
use trench_formation::kinematics::PointState;
use trench_formation::laws::{GoalMotion, NearestAttraction, RigidMotion};
use trench_formation::seek::{LeaderRule, SeekSettings};
use trench_formation::trench::Hyperbolic;
use trench_formation::zoning::{Edge, ObstaclePotential, Radii, Sharpness, Zoning};

fn at(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

fn settings(method: Method, sidesteps: bool) -> AgentSettings<Hyperbolic> {
    let radii = Radii::new(0.5, 1.5, 2.5, 8.0, 30.0).unwrap();
    AgentSettings {
        law: NearestAttraction { trench: Hyperbolic { alpha: 10.0, a: 1.0 }, damping: 2.0, leader_damping: 0.0 },
        method,
        zoning: Zoning::new(radii, (2.0, 3.0), Sharpness::One, Edge::Continuous, 50.0).unwrap(),
        potential: ObstaclePotential::new(0.2, 2.0, 4.0, Sharpness::Two, Edge::Continuous, 50.0).unwrap(),
        clearance: 0.1,
        seeking: SeekSettings {
            room: 0.0,
            transit_margin: 0.01,
            settled_distance: 0.1,
            settled_speed: 0.1,
            leader_rule: LeaderRule::StepSix,
        },
        encroaching: Encroaching::Nothing,
        remedies: None,
        limits: None,
        sidesteps,
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn rate_and_powers_are_the_derivative(
        x in -2.0..2.0_f64, y in 0.3..3.0_f64, vx in -1.0..1.0_f64, vy in -1.0..1.0_f64,
        drift_x in -1.0..1.0_f64, drift_y in -1.0..1.0_f64, ahead_x in -1.0..1.0_f64, ahead_y in -1.0..1.0_f64,
        method in prop_oneof![
            Just((Method::Nearest, false)),
            Just((Method::Directed { direction: None, compensates: true }, false)),
            Just((Method::Directed { direction: Some(at(0.6, -0.8)), compensates: true }, false)),
            Just((Method::Directed { direction: Some(at(0.6, 0.8)), compensates: false }, false)),
            Just((Method::Goal(None), true)),
        ],
        sidesteps in any::<bool>(),
    ) {
        let (method, to_goal) = method;
        let line = CurveShape::Line(at(-9.0, -0.5), at(9.0, 0.5));
        let curve = Curve::new(&line, false, false).unwrap();
        let drift = at(drift_x, drift_y);
        let square = [[-4.0, 1.0], [-3.0, 1.0], [-3.0, 2.0]].map(Vector2::from);
        let real = [Obstacle { id: 7, shape: Shape::new(&square, 0.1).unwrap() }];
        let apparent = combine(&real, 0.1).unwrap();
        let leader = PointState { position: at(4.0, 1.0), velocity: at(ahead_x, ahead_y) };
        let other = PointState { position: at(2.2, 1.5), velocity: at(-ahead_y, ahead_x) };
        let goal = GoalMotion { position: at(1.0, 0.0), velocity: drift, acceleration: at(0.2, 0.1) };
        let motion = RigidMotion { origin: GoalMotion { position: at(0.0, 0.0), ..goal }, ..RigidMotion::at_rest() };
        let around = Surroundings {
            clear: 0.0,
            time: 0.0,
            curve: &curve,
            map_from_segment: Isometry2::identity(),
            motion,
            goal: to_goal.then_some(goal),
            leader: (!to_goal).then_some(Leader { state: leader, deviation: 1.0 }),
            places: &[],
            behind: 0,
            ahead: if to_goal { &[] } else { std::slice::from_ref(&other) },
            real: &real,
            apparent: &apparent,
            velocities: &[at(ahead_y, ahead_y)],
        };
        let start = PointState { position: at(x, y), velocity: at(vx, vy) };
        for (distance, edge) in [
            ((leader.position - start.position).norm(), 1.5), ((leader.position - start.position).norm(), 2.5),
            ((other.position - start.position).norm(), 1.5),
            (apparent[0].shape.outline().approach(start.position).gap, 2.0),
        ] {
            prop_assume!((distance - edge).abs() > 1e-3);
        }
        let mut agent = Agent::new(settings(method, sidesteps));
        agent.sense(&around).unwrap();
        let now = agent.steer(&around, start, 0.0);
        let step = 1e-5;
        let mut value = |step: f64| agent.steer(&around, start.advanced(now.acceleration, step), step).steered.lyapunov;
        let slope = (value(step) - value(-step)) / (2.0 * step);
        let expected = now.steered.lyapunov_rate + now.powers.leader + now.powers.robots + now.powers.obstacles;
        prop_assert!((slope - expected).abs() < 1e-4 * (1.0 + slope.abs() + now.steered.lyapunov), "{slope} {expected} {now:?}");
        let own = now.steered.lyapunov - now.values.sum();
        prop_assert!(own >= 0.0, "what is left is kinetic and of the trench: {now:?}");
        prop_assert_eq!(agent.foreseen(&around, start, 0.0), now, "what is only asked for is the same");
        let forces = now.forces.of_potentials() + now.forces.damping;
        prop_assert!((forces - now.acceleration).norm() < 1e-9, "the terms add up");
    }
}
