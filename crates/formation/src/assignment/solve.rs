//! Optimal assignment by shortest augmenting paths (D. F. Crouse, "On implementing 2D rectangular assignment algorithms", IEEE
//! Transactions on Aerospace and Electronic Systems 52(4), 2016) behind the row reductions of R. Jonker and A. Volgenant ("A
//! shortest augmenting path algorithm for dense and sparse linear assignment problems", Computing 38, 1987), which place most
//! rows. Own code because the dual variables that certify the optimum are wanted, and no crate returns them.
use super::cheapest::{Cheapest, cheapest, next_at};
use super::search::Search;
use super::{AssignmentError, CostMatrix};
use crate::lanes::{Lanes, Work, in_widest};

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

pub(super) const FREE: usize = usize::MAX;

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
    // Where all columns are used their prices may be anything, and the least cost of each is a good one.
    let prices = if rows == columns { least_of_columns(costs) } else { vec![0.0; columns] };
    Ok(Solver::new(costs, prices).solve().lowered())
}

/// As [`solve`], for costs that differ little from those of `previous`: its dual variables leave little to do. As optimal, and as
/// proved, as without; of equally cheap assignments it may give another.
///
/// # Errors
/// More rows than columns.
pub fn solve_again(costs: &CostMatrix, previous: &Optimum) -> Result<Optimum, AssignmentError> {
    let fits = previous.columns.len() == costs.rows() && previous.duals.1.len() == costs.columns();
    if !fits || costs.rows() > costs.columns() || !previous.duals.1.iter().all(|v| *v <= 0.0) {
        return solve(costs);
    }
    let optimum = Solver::new(costs, previous.duals.1.clone()).solve();
    // A column that is no longer used may still have its price: then the proof does not hold.
    let mut used = vec![false; costs.columns()];
    optimum.columns.iter().for_each(|column| used[*column] = true);
    if optimum.duals.1.iter().zip(used).any(|(v, used)| !used && *v != 0.0) {
        return solve(costs);
    }
    Ok(optimum)
}

fn least_of_columns(costs: &CostMatrix) -> Vec<f64> {
    let mut least = vec![f64::INFINITY; costs.columns()];
    for row in 0..costs.rows() {
        for (least, cost) in least.iter_mut().zip(costs.row(row)) {
            *least = if cost < least { *cost } else { *least };
        }
    }
    least
}

/// A partial assignment with dual variables that satisfy all conditions of optimality, at any time.
struct Solver<'a> {
    costs: &'a CostMatrix,
    u: Vec<f64>,
    v: Vec<f64>,
    row_of: Vec<usize>,
    column_of: Vec<usize>,
}

impl<'a> Solver<'a> {
    fn new(costs: &'a CostMatrix, v: Vec<f64>) -> Self {
        let (row_of, column_of) = (vec![FREE; costs.columns()], vec![FREE; costs.rows()]);
        Self { costs, u: vec![0.0; costs.rows()], v, row_of, column_of }
    }

    fn solve(self) -> Optimum {
        in_widest(self)
    }

    /// Gives each row its cheapest column if that is free; the rows that are left.
    #[inline(always)]
    fn reduce_rows<L: Lanes>(&mut self) -> Vec<usize> {
        let mut waiting = Vec::new();
        for row in 0..self.column_of.len() {
            let Cheapest { first, column, .. } = self.cheapest::<L>(row);
            self.u[row] = first;
            if self.row_of[column] == FREE {
                self.assign(row, column);
            } else {
                waiting.push(row);
            }
        }
        waiting
    }

    /// Lets each waiting row have its cheapest column, whose price falls until the second cheapest is as good; whoever had the
    /// column waits.
    #[inline(always)]
    fn augment_rows<L: Lanes>(&mut self, rows: Vec<usize>) -> Vec<usize> {
        let (mut waiting, mut moves) = (Vec::new(), 0);
        for mut row in rows {
            loop {
                let Cheapest { first, second, mut column } = self.cheapest::<L>(row);
                let falls = first < second && second.is_finite();
                if falls {
                    self.v[column] -= second - first;
                } else if self.row_of[column] != FREE && first == second {
                    column = next_at::<L>(self.costs.row(row), &self.v, column + 1, first).unwrap_or(column);
                }
                self.u[row] = if falls { second } else { first };
                let evicted = self.row_of[column];
                if evicted != FREE && !falls {
                    waiting.push(row);
                    break;
                }
                self.assign(row, column);
                moves += 1;
                if evicted == FREE {
                    break;
                }
                self.column_of[evicted] = FREE;
                // Rounding could let two rows outbid each other for ever.
                if moves > 8 * self.column_of.len() {
                    waiting.push(evicted);
                    break;
                }
                row = evicted;
            }
        }
        for row in &waiting {
            self.u[*row] = self.cheapest::<L>(*row).first;
        }
        waiting
    }

    fn assign(&mut self, row: usize, column: usize) {
        self.row_of[column] = row;
        self.column_of[row] = column;
    }

    #[inline(always)]
    fn cheapest<L: Lanes>(&self, row: usize) -> Cheapest {
        cheapest::<L>(self.costs.row(row), &self.v)
    }
}

impl Work for Solver<'_> {
    type Output = Optimum;

    #[inline(always)]
    fn in_lanes<L: Lanes>(mut self) -> Optimum {
        let waiting = self.reduce_rows::<L>();
        let waiting = self.augment_rows::<L>(waiting);
        let mut search = Search::new(self.costs.columns());
        for row in waiting {
            let end = search.shortest_path::<L>(self.costs, row, (&self.u, &self.v), &self.row_of);
            search.update(row, (&mut self.u, &mut self.v), &self.row_of);
            let mut column = end;
            while column != FREE {
                let from = search.previous(column);
                self.row_of[column] = from;
                column = core::mem::replace(&mut self.column_of[from], column);
                if from == row {
                    break;
                }
            }
        }
        let total = self.column_of.iter().enumerate().map(|(row, column)| self.costs.at(row, *column)).sum();
        Optimum { columns: self.column_of, total, duals: (self.u, self.v) }
    }
}

impl Optimum {
    /// The same with all v_j <= 0, which costs nothing: what the columns give up goes to the rows.
    fn lowered(mut self) -> Self {
        let (u, v) = &mut self.duals;
        let highest = v.iter().copied().fold(0.0, f64::max);
        if highest > 0.0 {
            u.iter_mut().for_each(|u| *u += highest);
            v.iter_mut().for_each(|v| *v -= highest);
        }
        self
    }

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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use wide::f64x4;

    proptest! {
        #[test]
        fn processors_with_and_without_avx_assign_alike(
            values in prop::collection::vec(0..200_u32, 40 * 41), changes in prop::collection::vec(0..9_u32, 40 * 41),
            rows in 1..40_usize, spare in 0..2_usize,
        ) {
            let columns = rows + spare;
            let costs = |values: Vec<f64>| CostMatrix::new(values[..rows * columns].to_vec(), rows, columns).unwrap();
            let before = costs(values.iter().map(|value| 0.1 * f64::from(*value)).collect());
            let sums = values.iter().zip(&changes).map(|(value, change)| 0.1 * f64::from(value + change));
            let after = costs(sums.collect());
            let prices = || solve(&before).unwrap().duals.1;
            prop_assert_eq!(Solver::new(&before, prices()).solve(), Solver::new(&before, prices()).in_lanes::<f64x4>());
            prop_assert_eq!(Solver::new(&after, prices()).solve(), Solver::new(&after, prices()).in_lanes::<f64x4>());
        }
    }
}
