//! Robots to places at the least sum of squared distances, with the proof.
use crate::files::random;
use crate::output::Output;
use std::error::Error;
use trench_formation::assignment::{AssignmentError, CostMatrix, solve, solve_again};

type Points = Vec<[f64; 2]>;

fn points(count: usize, state: &mut u64) -> Points {
    (0..count).map(|_| [random(state), random(state)]).collect()
}

fn costs_of(robots: &Points, places: &Points) -> Result<CostMatrix, AssignmentError> {
    let cost = |robot: &[f64; 2], place: &[f64; 2]| (robot[0] - place[0]).powi(2) + (robot[1] - place[1]).powi(2);
    let values = robots.iter().flat_map(|robot| places.iter().map(move |place| cost(robot, place))).collect();
    CostMatrix::new(values, robots.len(), places.len())
}

pub(crate) fn measure(output: &mut Output) -> Result<(), Box<dyn Error>> {
    let mut state = 3;
    for (count, runs) in [(100, 200), (1000, 9)] {
        let (robots, places) = (points(count, &mut state), points(count, &mut state));
        let costs = costs_of(&robots, &places)?;
        let optimum = output.time(&format!("assignment: {count}"), runs, 1, || solve(&costs))?;
        let mut nudge = || 0.01 * (random(&mut state) - 0.5);
        let moved: Points = robots.iter().map(|point| [point[0] + nudge(), point[1] + nudge()]).collect();
        let name = format!("assignment: {count} again, robots moved 1 %");
        let again = output.time(&name, runs, 1, || {
            let changed = costs_of(&moved, &places)?;
            solve_again(&changed, &optimum)
        })?;
        assert!(again.violation(&costs_of(&moved, &places)?) < 1e-12, "the duals prove the optimum");
        assert!(optimum.violation(&costs) < 1e-12, "the duals prove the optimum");
        output.rows(&format!("robots_{count}.txt"), robots.iter().map(|point| point.to_vec()))?;
        output.rows(&format!("places_{count}.txt"), places.iter().map(|point| point.to_vec()))?;
        output.rows(&format!("assignment_{count}.txt"), optimum.columns.iter().map(|column| vec![*column as f64]))?;
    }
    Ok(())
}
