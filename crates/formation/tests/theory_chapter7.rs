//! Chapter 7: the simulation of 7.10, with and without obstacles.
#![expect(clippy::unwrap_used, reason = "a test may fail by a panic in a function of its own")]
mod chapter7;

use chapter7::{Run, chain_of_7_10, run};
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveShape};
use trench_formation::seek::LeaderRule;
use trench_formation::simulate::{ChainScenario, Encroaching, ScenarioError};
use trench_formation::trench::Hyperbolic;
use trench_formation::zoning::Zone;

fn leader_distances(run: &Run) -> Vec<f64> {
    run.robots.windows(2).map(|pair| (pair[0].position - pair[1].position).norm()).collect()
}

fn assert_near(got: &[f64], wanted: &[f64], tolerance: f64) {
    let near = got.len() == wanted.len() && got.iter().zip(wanted).all(|(a, b)| (a - b).abs() < tolerance);
    assert!(near, "{got:?} is not {wanted:?}");
}

fn xs(run: &Run) -> Vec<f64> {
    run.robots.iter().map(|robot| robot.position.x).collect()
}

#[test]
fn without_obstacles() {
    let run = run(ChainScenario { obstacles: Vec::new(), ..chain_of_7_10(2.0) });
    let expected = [8.7714, 9.8873, 9.8957, 9.8966, 9.8969, 9.8971, 9.8973, 9.8974, 9.8974];
    assert_near(&leader_distances(&run), &expected, 4e-3);
    assert!((run.robots[0].position - Vector2::new(100.0, 100.0)).norm() < 1e-6);
    assert!((run.robots[9].position.x - 37.819).abs() < 4e-3, "{}", run.robots[9].position.x);
    assert!(run.robots.iter().all(|robot| (robot.position.x - robot.position.y).abs() < 1e-6));
    assert!(run.closest > 3.6, "{}", run.closest);
}

/// The figures of ERRATA: nearest points on the whole segment.
#[test]
fn with_obstacles_on_the_whole_segment() {
    let run = run(chain_of_7_10(5.0));
    assert_near(&run.nearest_obstacles, &[3.534, 2.660, 2.625, 2.732], 2e-2);
    let expected = [100.0, 92.940, 86.872, 79.811, 72.751, 65.690, 58.630, 51.569, 44.509, 37.448];
    assert_near(&xs(&run), &expected, 2e-2);
    assert!(run.closest > 3.5, "{}", run.closest);
}
