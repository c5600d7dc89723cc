//! Runs do not depend on the number of threads, and what is out of reach is not looked at.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#[path = "chapter7/chain.rs"]
mod chain;
mod threads;

use chain::chain_of_7_10;
use nalgebra::Vector2;
use threads::Threads;
use trench_formation::curve::{Curve, CurveShape};
use trench_formation::kinematics::PointState;
use trench_formation::laws::Capability;
use trench_formation::safety::Stopping;
use trench_formation::simulate::{ChainScenario, ChainSimulation, Options};
use trench_formation::trench::Hyperbolic;

/// 7.10's law and discs for 300 robots in two rows beside a long segment.
fn many() -> ChainScenario<Hyperbolic> {
    let line = CurveShape::Line(Vector2::new(0.0, 0.0), Vector2::new(1400.0, 0.0));
    let place =
        |rank: u32| Vector2::new(1390.0 - 4.5 * f64::from(rank), if rank.is_multiple_of(2) { 5.0 } else { -3.0 });
    let capability = Capability { speed: 3.0, acceleration: 40.0 };
    ChainScenario {
        segment: Curve::new(&line, false, false).unwrap(),
        team_goal: Some(Vector2::new(1400.0, 0.0)),
        robots: (0..300).map(|rank| PointState::at_rest(place(rank))).collect(),
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
    (0..600).for_each(|_| simulation.step().unwrap());
    simulation.robots().to_vec()
}

#[test]
fn one_thread_or_several() {
    let run = |threads| end(ChainSimulation::new(many()).unwrap().with(Threads(threads)));
    let alone = run(1);
    assert_eq!(alone, run(2));
    assert_eq!(alone, run(5));
    assert!(alone.iter().all(|robot| robot.position.y.abs() < 3.0), "they are on their way to the segment");
}
