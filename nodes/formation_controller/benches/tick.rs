//! How long a tick takes, and what a picture costs: `cargo bench -p formation_controller --bench tick`. Prints the best and the median
//! of 15 runs of 300 ticks.
#![expect(clippy::print_stdout, reason = "the figures are the purpose")]
#![expect(clippy::unwrap_used, reason = "a bench that cannot go on stops")]
#[path = "../tests/node/bench.rs"]
#[expect(dead_code, reason = "the tests use the rest")]
mod bench;

use bench::{Bench, formation, leader, make};
use std::time::Instant;
use trench_core::Action;
use trench_formation::kinematics::Pose;
use trench_msgs::msg::{ApparentObstacle, ApparentObstacleArray, Obstacle, Point2};

const TICKS: u32 = 300;

/// Eight walls about the robot's way, in four hulls.
fn obstacles() -> ApparentObstacleArray {
    let corners = |x: f64, y: f64| {
        [(0.0, 0.0), (0.3, 0.0), (0.3, 0.2), (0.0, 0.2)].map(|(dx, dy)| Point2 { x: x + dx, y: y + dy })
    };
    let mut message = ApparentObstacleArray::default();
    for index in 0..4_u32 {
        let (x, y) = (0.3 + 0.5 * f64::from(index), if index % 2 == 0 { 1.5 } else { 0.2 });
        let members = vec![2 * index, 2 * index + 1];
        for id in &members {
            let polygon = corners(x, y).to_vec();
            message.members.push(Obstacle { id: *id, polygon, radius: 0.02, ..Default::default() });
        }
        let hull = corners(x, y).to_vec();
        message.obstacles.push(ApparentObstacle { id: 2 * index, hull, radius: 0.02, members, ..Default::default() });
    }
    message
}

/// Microseconds a tick, and bytes published a tick.
fn run(law: &str, period: &str) -> (f64, f64) {
    let overrides = [("team", "[robot1, robot2]"), ("law", law), ("encroaching", "robots"), ("markers.period", period)];
    let mut bench = Bench::of(make(&overrides).unwrap());
    formation(&mut bench);
    bench.pose = Pose::new(1.0, 1.1, 1.2);
    bench.obstacles = obstacles();
    let (mut elapsed, mut bytes) = (0.0, 0);
    for _ in 0..TICKS {
        leader(&mut bench);
        bench.out.take();
        let start = Instant::now();
        bench.drive(1);
        elapsed += start.elapsed().as_secs_f64();
        let published = bench.out.actions.iter().map(|action| match action {
            Action::Publish { cdr, .. } => cdr.len(),
            _ => 0,
        });
        bytes += published.sum::<usize>();
    }
    (1e6 * elapsed / f64::from(TICKS), bytes as f64 / f64::from(TICKS))
}

fn main() {
    for (law, period) in [("robust", "0.0"), ("chain", "0.0"), ("chain", "0.4"), ("chain", "0.001")] {
        let mut runs: Vec<(f64, f64)> = (0..15).map(|_| run(law, period)).collect();
        runs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (best, median) = (runs[0], runs[runs.len() / 2]);
        println!(
            "{law}, a picture every {period} s: best {:.1} us, median {:.1} us, {:.0} bytes a tick",
            best.0, median.0, best.1
        );
    }
}
