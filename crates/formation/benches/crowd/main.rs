//! Steps of many robots under the full law (7.13), measured and written out for pyrvo: `scripts/bench crowd`, or by itself
//! `cargo bench -p trench_formation --bench crowd [-- FOLDER]`.
#![expect(clippy::print_stdout, reason = "the figures are the purpose")]
#[path = "../peers/files.rs"]
mod files;
#[path = "../../tests/threads/mod.rs"]
mod threads;

use files::{Files, random};
use std::error::Error;
use std::time::{Duration, Instant};
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
/// Steps between which pyrvo's robots are told anew where to go, and how many times that is timed.
const STEPS: usize = 20;
const RUNS: usize = 15;
const FEW: u32 = 250;
const MANY: u32 = 20_000;

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

/// Goes for 16 times 20 steps from the start, of which the first twenty do not count, and starts again until as many agent steps were
/// made as by [`MANY`] robots once: a run of few robots lasts less than a moment in which somebody else has the caches.
/// Seconds an agent step, and where the robots end.
fn measure(scenario: &ChainScenario<Hyperbolic>, threads: usize) -> Result<(f64, Vec<PointState>), Box<dyn Error>> {
    let count = scenario.robots.len();
    let repeats = MANY as usize / count;
    let mut taken = Duration::ZERO;
    let mut moved = Vec::new();
    for _ in 0..repeats {
        let mut simulation = ChainSimulation::new(scenario.clone())?.with(Threads(threads));
        (0..STEPS).try_for_each(|_| simulation.step())?;
        let begin = Instant::now();
        (0..RUNS * STEPS).try_for_each(|_| simulation.step())?;
        taken += begin.elapsed();
        moved = simulation.robots().to_vec();
    }
    Ok((taken.as_secs_f64() / (repeats * RUNS * STEPS * count) as f64, moved))
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().skip(1).find(|argument| !argument.starts_with("--"));
    let files = Files::new(folder)?;
    for count in [FEW, MANY] {
        let scenario = scenario(count)?;
        let rows = |points: &mut dyn Iterator<Item = Vector2<f64>>| {
            points.map(|point| vec![point.x, point.y]).collect::<Vec<_>>().into_iter()
        };
        let starts = scenario.robots.iter().map(|robot| robot.position);
        files.rows(&format!("starts_{count}.txt"), rows(&mut starts.clone()))?;
        // What a scenario file of the same needs besides.
        files.rows(&format!("goal_{count}.txt"), rows(&mut scenario.team_goal.into_iter()))?;
        let discs = scenario.obstacles.iter().map(|disc| disc.shape.outline().points[0]);
        files.rows(&format!("discs_{count}.txt"), rows(&mut discs.into_iter()))?;
        let mut nearest = starts.map(|start| scenario.segment.nearest(start).point);
        files.rows(&format!("ends_{count}.txt"), rows(&mut nearest))?;
        let (one, moved) = measure(&scenario, 1)?;
        let (two, same) = measure(&scenario, 2)?;
        if moved != same {
            return Err(format!("{count} robots move differently on two threads").into());
        }
        println!("{count:>6} robots: {:.3} us an agent step, {:.3} us on two threads", 1e6 * one, 1e6 * two);
        files.rows(&format!("times_{count}.txt"), [vec![one, two]].into_iter())?;
        files.rows(&format!("moved_{count}.txt"), rows(&mut moved.iter().map(|robot| robot.position)))?;
    }
    Ok(())
}
