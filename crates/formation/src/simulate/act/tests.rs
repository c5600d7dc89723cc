//! Four robots side by side move alike on every processor.
use super::super::{Carriage, ChainSimulation, Encroaching, Options};
use super::*;
use crate::curve::{Curve, CurveShape};
use crate::hull::Shape;
use crate::lanes::HIDDEN;
use crate::laws::{Capability, NearestAttraction};
use crate::safety::Stopping;
use crate::seek::{LeaderRule, SeekSettings};
use crate::trench::Hyperbolic;
use crate::zoning::{Edge, ObstaclePotential, Radii, Sharpness, Zoning};

const ROBOT: Capability = Capability { speed: 0.5, acceleration: 2.0 };

/// Thirty robots beside a winding segment and a disc; in each four some that go by themselves.
fn scenario() -> ChainScenario<Hyperbolic> {
    let (origin, length) = (Vector2::zeros(), 40.0);
    let shape = CurveShape::Sinusoid { origin, direction: 0.0, length, amplitude: 2.0, wavelength: 20.0, phase: 0.0 };
    let segment = Curve::new(&shape, false, false).unwrap();
    let start = |rank: u32| {
        let foot = segment.at(length - 1.2 * f64::from(rank + 1));
        let across = Vector2::new(-foot.tangent.y, foot.tangent.x);
        PointState::at_rest(foot.point + libm::sin(f64::from(7 * rank)) * across)
    };
    let obstacles =
        vec![Obstacle { id: 0, shape: Shape::new(&[segment.at(20.0).point + Vector2::new(0.0, 1.8)], 0.5).unwrap() }];
    ChainScenario {
        team_goal: Some(segment.at(length).point),
        carriage: Carriage::parked(),
        robots: (0..30).map(start).collect(),
        law: NearestAttraction { trench: Hyperbolic { alpha: 0.5, a: 0.5 }, damping: 2.0, leader_damping: 0.0 },
        zoning: Zoning::new(
            Radii::new(0.4, 1.0, 3.0, 6.0, 10.0).unwrap(),
            (0.2, 0.05),
            Sharpness::One,
            Edge::Continuous,
            1.0,
        )
        .unwrap(),
        segment,
        obstacles,
        clearance: 1.0,
        potential: ObstaclePotential::new(0.2, 0.5, 0.1, Sharpness::One, Edge::Continuous, 0.5).unwrap(),
        seeking: SeekSettings {
            room: 0.05,
            transit_margin: 0.05,
            settled_distance: 0.1,
            settled_speed: 0.05,
            leader_rule: LeaderRule::StepSix,
        },
        encroaching: Encroaching::Obstacles,
        remedies: None,
        options: Options {
            limits: Some(ROBOT),
            sidesteps: true,
            safety: Some(Stopping { radius: 0.11, capability: ROBOT }),
            ..Options::default()
        },
        step: 0.033,
        steps_per_tick: 1,
    }
}

/// Where the robots of each step are, bit for bit.
fn motion(hidden: bool) -> Vec<[u64; 4]> {
    HIDDEN.set(hidden);
    let mut simulation = ChainSimulation::new(scenario()).unwrap();
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
    let (with, without) = (motion(false), motion(true));
    assert!(with[with.len() - 30..].iter().zip(&with[..30]).all(|(last, first)| last != first), "somebody never moved");
    assert_eq!(with, without);
}
