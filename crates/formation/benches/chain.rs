//! How long 7.10 takes: `cargo bench -p trench_formation --bench chain`. Prints the best and the median of 15 runs.
#![expect(clippy::print_stdout, reason = "the figures are the purpose")]
#![expect(clippy::unwrap_used, reason = "the scenario of the tests is a good one")]
#[path = "../tests/chapter7/chain.rs"]
mod chain;

use chain::chain_of_7_10;
use std::time::Instant;
use trench_formation::simulate::{ChainScenario, ChainSimulation, Encroaching};
use trench_formation::trench::Hyperbolic;

fn measure(name: &str, scenario: &ChainScenario<Hyperbolic>) {
    let steps = (200.0 / scenario.step).round() as u32;
    let mut times: Vec<f64> = (0..15)
        .filter_map(|_| {
            let mut simulation = ChainSimulation::new(scenario.clone()).ok()?;
            let start = Instant::now();
            (0..steps).try_for_each(|_| simulation.step()).ok()?;
            Some(1e3 * start.elapsed().as_secs_f64())
        })
        .collect();
    times.sort_by(f64::total_cmp);
    println!("{name}: best {:.1} ms, median {:.1} ms of {}", times[0], times[times.len() / 2], times.len());
}

fn main() {
    let free = ChainScenario { obstacles: Vec::new(), step: 0.01, ..chain_of_7_10(2.0) };
    measure("7.10, 200 s at 100 Hz, no obstacles", &free);
    let fragments = ChainScenario { encroaching: Encroaching::Obstacles, ..chain_of_7_10(5.0) };
    measure("7.10, 200 s at 1 kHz, four discs, fragments, step (6)", &fragments);
}
