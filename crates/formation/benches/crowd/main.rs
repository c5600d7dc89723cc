//! Steps of many robots under the full law (7.13), measured and written out for pyrvo: `scripts/bench crowd`, or by itself
//! `cargo bench -p trench_formation --bench crowd [-- FOLDER]`.
#![expect(clippy::print_stdout, reason = "the figures are the purpose")]
#[path = "../peers/output.rs"]
mod output;
#[path = "../../tests/threads/mod.rs"]
mod threads;

use output::{Output, random};
use std::error::Error;
use threads::Threads;
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveShape};
use trench_formation::hull::{Obstacle, Shape};
use trench_formation::kinematics::PointState;
use trench_formation::laws::{Capability, NearestAttraction};
use trench_formation::safety::Stopping;
use trench_formation::seek::{LeaderRule, SeekSettings};
use trench_formation::simulate::{Carriage, ChainScenario, ChainSimulation, Encroaching, Options};
use trench_formation::trench::Hyperbolic;
use trench_formation::zoning::{Edge, ObstaclePotential, Radii, Sharpness, Zoning};

/// s: a camera's frame.
const TICK: f64 = 0.033;
const ROBOT: Capability = Capability { speed: 0.5, acceleration: 2.0 };
/// m of segment for each robot, and how far from it they start at most.
const SPACING: f64 = 1.2;
const ASIDE: f64 = 3.0;
/// Steps that are timed together.
const STEPS: usize = 20;

/// A chain along a winding segment among four discs: nearest points on fragments, zones, limits, safety filter.
fn scenario(count: u32) -> Result<ChainScenario<Hyperbolic>, Box<dyn Error>> {
    let length = SPACING * f64::from(count + 3);
    let (origin, amplitude, wavelength) = (Vector2::zeros(), 4.0, 40.0);
    let shape = CurveShape::Sinusoid { origin, direction: 0.0, length, amplitude, wavelength, phase: 0.0 };
    let segment = Curve::new(&shape, false, false)?;
    let mut state = u64::from(count);
    let start = |rank: u32| {
        let foot = segment.at(length - SPACING * f64::from(rank + 1));
        let across = Vector2::new(-foot.tangent.y, foot.tangent.x);
        PointState::at_rest(foot.point + ASIDE * (2.0 * random(&mut state) - 1.0) * across)
    };
    let robots: Vec<PointState> = (0..count).map(start).collect();
    let disc = |id: u32| {
        let foot = segment.at(0.2 * length * f64::from(id + 1));
        let beside = foot.point + 4.5 * Vector2::new(-foot.tangent.y, foot.tangent.x);
        Ok::<_, Box<dyn Error>>(Obstacle { id, shape: Shape::new(&[beside], 0.5)? })
    };
    let obstacles = (0..4).map(disc).collect::<Result<_, _>>()?;
    Ok(ChainScenario {
        team_goal: Some(segment.at(length).point),
        segment,
        carriage: Carriage::parked(),
        robots,
        law: NearestAttraction { trench: Hyperbolic { alpha: 0.5, a: 0.5 }, damping: 2.0, leader_damping: 0.0 },
        zoning: Zoning::new(Radii::new(0.4, 1.0, 3.0, 6.0, 10.0)?, (0.2, 0.05), Sharpness::One, Edge::Continuous, 1.0)?,
        obstacles,
        clearance: 1.0,
        potential: ObstaclePotential::new(0.2, 0.5, 0.1, Sharpness::One, Edge::Continuous, 0.5)?,
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
        step: TICK,
        steps_per_tick: 1,
    })
}

/// Goes on for 16 times as many steps; the fastest of them count. Where the robots end.
fn measure(
    output: &mut Output,
    scenario: &ChainScenario<Hyperbolic>,
    threads: usize,
) -> Result<Vec<PointState>, Box<dyn Error>> {
    let count = scenario.robots.len();
    let mut simulation = ChainSimulation::new(scenario.clone())?.with(Threads(threads));
    let name = format!("crowd: {count} robots, {threads} threads");
    let mut failed = Ok(());
    output.time(&name, 15, STEPS * count, || {
        if failed.is_ok() {
            failed = (0..STEPS).try_for_each(|_| simulation.step());
        }
    });
    failed?;
    Ok(simulation.robots().to_vec())
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().skip(1).find(|argument| !argument.starts_with("--"));
    let mut output = Output::new(folder)?;
    for count in [250, 20_000] {
        let scenario = scenario(count)?;
        let rows = |points: &mut dyn Iterator<Item = Vector2<f64>>| {
            points.map(|point| vec![point.x, point.y]).collect::<Vec<_>>().into_iter()
        };
        let starts = scenario.robots.iter().map(|robot| robot.position);
        output.rows(&format!("starts_{count}.txt"), rows(&mut starts.clone()))?;
        // What a scenario file of the same needs besides.
        output.rows(&format!("goal_{count}.txt"), rows(&mut scenario.team_goal.into_iter()))?;
        let discs = scenario.obstacles.iter().map(|disc| disc.shape.outline().points[0]);
        output.rows(&format!("discs_{count}.txt"), rows(&mut discs.into_iter()))?;
        let mut nearest = starts.map(|start| scenario.segment.nearest(start).point);
        output.rows(&format!("ends_{count}.txt"), rows(&mut nearest))?;
        let moved = measure(&mut output, &scenario, 1)?;
        if moved != measure(&mut output, &scenario, 2)? {
            return Err(format!("{count} robots move differently on two threads").into());
        }
        output.rows(&format!("moved_{count}.txt"), rows(&mut moved.iter().map(|robot| robot.position)))?;
    }
    output.finish()
}
