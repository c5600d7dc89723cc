//! Robots to places at the least sum of squared distances, with the proof.
use crate::files::random;
use crate::output::Output;
use std::error::Error;
use trench_formation::Vector2;
use trench_formation::assignment::{CostMatrix, solve, solve_again};

fn points(count: usize, state: &mut u64) -> Vec<Vector2<f64>> {
    (0..count).map(|_| Vector2::new(random(state), random(state))).collect()
}

pub(crate) fn measure(output: &mut Output) -> Result<(), Box<dyn Error>> {
    let mut state = 3;
    for (count, runs) in [(100, 200), (1000, 9)] {
        let (robots, places) = (points(count, &mut state), points(count, &mut state));
        let costs = CostMatrix::squared_distances(&robots, &places)?;
        let optimum = output.time(&format!("assignment: {count}"), runs, 1, || solve(&costs))?;
        let mut nudge = || 0.01 * (random(&mut state) - 0.5);
        let moved: Vec<_> = robots.iter().map(|point| point + Vector2::new(nudge(), nudge())).collect();
        let name = format!("assignment: {count} again, robots moved 1 %");
        let again = output.time(&name, runs, 1, || {
            let changed = CostMatrix::squared_distances(&moved, &places)?;
            solve_again(&changed, &optimum)
        })?;
        assert!(
            again.violation(&CostMatrix::squared_distances(&moved, &places)?) < 1e-12,
            "the duals prove the optimum"
        );
        assert!(optimum.violation(&costs) < 1e-12, "the duals prove the optimum");
        output.rows(&format!("robots_{count}.txt"), robots.iter().map(|point| vec![point.x, point.y]))?;
        output.rows(&format!("places_{count}.txt"), places.iter().map(|point| vec![point.x, point.y]))?;
        output.rows(&format!("assignment_{count}.txt"), optimum.columns.iter().map(|column| vec![*column as f64]))?;
    }
    Ok(())
}
