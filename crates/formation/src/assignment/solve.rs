//! Optimal assignment by shortest augmenting paths (D. F. Crouse, "On implementing 2D rectangular assignment
//! algorithms", IEEE Transactions on Aerospace and Electronic Systems 52(4), 2016). Own code because the dual variables
//! that certify the optimum are wanted, and no crate returns them.
use super::{AssignmentError, CostMatrix};

/// A cheapest assignment and the proof that it is one.
#[derive(Debug, Clone, PartialEq)]
pub struct Optimum {
    /// Column of each row.
    pub columns: Vec<usize>,
    /// Sum of the costs of the assignment.
    pub total: f64,
    /// Dual variables of rows and columns: u_i + v_j <= c_ij, with equality on the assignment; v_j <= 0, and 0 on free
    /// columns.
    pub duals: (Vec<f64>, Vec<f64>),
}

const FREE: usize = usize::MAX;

/// Gives each row its own column at the least total cost. Of equally cheap assignments, always the same one for the same
/// matrix.
///
/// # Errors
/// More rows than columns.
pub fn solve(costs: &CostMatrix) -> Result<Optimum, AssignmentError> {
    let (rows, columns) = (costs.rows(), costs.columns());
    if rows > columns {
        return Err(AssignmentError::TooFewPlaces { rows, columns });
    }
    let mut u = vec![0.0; rows];
    let mut v = vec![0.0; columns];
    let mut row_of = vec![FREE; columns];
    let mut column_of = vec![FREE; rows];
    for row in 0..rows {
        let mut search = Search::new(columns);
        let end = search.shortest_path(costs, row, (&u, &v), &row_of);
        search.update(row, (&mut u, &mut v), &column_of);
        let mut column = end;
        while column != FREE {
            let from = search.previous[column];
            row_of[column] = from;
            column = core::mem::replace(&mut column_of[from], column);
            if from == row {
                break;
            }
        }
    }
    let total = column_of.iter().enumerate().map(|(row, column)| costs.at(row, *column)).sum();
    Ok(Optimum { columns: column_of, total, duals: (u, v) })
}

/// Dijkstra's search from one row over reduced costs.
struct Search {
    distance: Vec<f64>,
    previous: Vec<usize>,
    scanned: Vec<bool>,
    reached: f64,
}

impl Search {
    fn new(columns: usize) -> Self {
        let (distance, previous) = (vec![f64::INFINITY; columns], vec![FREE; columns]);
        Self { distance, previous, scanned: vec![false; columns], reached: 0.0 }
    }

    /// The nearest free column.
    fn shortest_path(&mut self, costs: &CostMatrix, from: usize, (u, v): (&[f64], &[f64]), row_of: &[usize]) -> usize {
        let mut row = from;
        loop {
            let mut nearest = FREE;
            for column in (0..self.distance.len()).filter(|column| !self.scanned[*column]) {
                let distance = self.reached + costs.at(row, column) - u[row] - v[column];
                if distance < self.distance[column] {
                    (self.distance[column], self.previous[column]) = (distance, row);
                }
                // Ties go to a free column, which ends the search.
                let better = nearest == FREE
                    || self.distance[column] < self.distance[nearest]
                    || (self.distance[column] == self.distance[nearest]
                        && row_of[column] == FREE
                        && row_of[nearest] != FREE);
                if better {
                    nearest = column;
                }
            }
            self.reached = self.distance[nearest];
            self.scanned[nearest] = true;
            if row_of[nearest] == FREE {
                return nearest;
            }
            row = row_of[nearest];
        }
    }

    fn update(&self, from: usize, (u, v): (&mut [f64], &mut [f64]), column_of: &[usize]) {
        u[from] += self.reached;
        for (row, column) in column_of.iter().enumerate() {
            if *column != FREE && self.scanned[*column] {
                u[row] += self.reached - self.distance[*column];
            }
        }
        for (column, value) in v.iter_mut().enumerate().filter(|(column, _)| self.scanned[*column]) {
            *value -= self.reached - self.distance[column];
        }
    }
}

impl Optimum {
    /// Greatest violation of the conditions of optimality, in units of cost: 0 up to rounding proves that no assignment
    /// is cheaper (complementary slackness).
    pub fn violation(&self, costs: &CostMatrix) -> f64 {
        let (u, v) = &self.duals;
        let mut worst = v.iter().copied().fold(0.0, f64::max);
        for (row, row_dual) in u.iter().enumerate() {
            for (column, column_dual) in v.iter().enumerate() {
                let slack = costs.at(row, column) - row_dual - column_dual;
                worst = worst.max(if self.columns[row] == column { slack.abs() } else { -slack });
            }
        }
        let free = (0..costs.columns()).filter(|column| !self.columns.contains(column));
        free.map(|column| v[column].abs()).fold(worst, f64::max)
    }
}
