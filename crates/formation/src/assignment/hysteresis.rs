//! Keeps an assignment unless another is worth the change: noise of poses must not swap robots to and fro.
use super::{AssignmentError, CostMatrix, solve};

/// By how much a new assignment must be cheaper: by both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hysteresis {
    /// As a part of the present cost.
    pub relative: f64,
    /// In units of cost (m^2 for squared distances).
    pub absolute: f64,
}

/// The present columns of the rows if they are a valid assignment and none is cheaper by both margins; else the
/// cheapest.
///
/// # Errors
/// More rows than columns.
pub fn reassign(costs: &CostMatrix, present: &[usize], margin: Hysteresis) -> Result<Vec<usize>, AssignmentError> {
    let optimum = solve(costs)?;
    let distinct = |(row, column): (usize, &usize)| *column < costs.columns() && !present[..row].contains(column);
    if present.len() != costs.rows() || !present.iter().enumerate().all(distinct) {
        return Ok(optimum.columns);
    }
    let cost: f64 = present.iter().enumerate().map(|(row, column)| costs.at(row, *column)).sum();
    let gain = cost - optimum.total;
    let worth_it = gain > margin.absolute && gain > margin.relative * cost;
    Ok(if worth_it { optimum.columns } else { present.to_vec() })
}

/// Queue of each robot: `squared_distances` has a row a robot and a column a queue, `counts` says how many robots a
/// queue gets, `present` which queue each robot is in (empty if none yet).
///
/// # Errors
/// Counts that do not fit the columns or give fewer places than robots.
pub fn assign_to_queues(
    squared_distances: &CostMatrix,
    counts: &[usize],
    present: &[usize],
    margin: Hysteresis,
) -> Result<Vec<usize>, AssignmentError> {
    if counts.len() != squared_distances.columns() {
        return Err(AssignmentError::Shape { values: counts.len(), columns: squared_distances.columns() });
    }
    let queue_of: Vec<usize> =
        counts.iter().enumerate().flat_map(|(queue, count)| core::iter::repeat_n(queue, *count)).collect();
    let rows = squared_distances.rows();
    let values =
        (0..rows).flat_map(|row| queue_of.iter().map(move |queue| squared_distances.at(row, *queue))).collect();
    let costs = CostMatrix::new(values, rows, queue_of.len())?;
    // Places of one queue cost the same, so a robot may take any free place of its present queue.
    let mut taken = vec![false; queue_of.len()];
    let place = |queue: &usize| {
        let free = (0..queue_of.len()).find(|place| queue_of[*place] == *queue && !taken[*place]);
        free.inspect(|place| taken[*place] = true)
    };
    let places: Option<Vec<usize>> = present.iter().map(place).collect();
    let columns = reassign(&costs, &places.unwrap_or_default(), margin)?;
    Ok(columns.into_iter().map(|column| queue_of[column]).collect())
}
