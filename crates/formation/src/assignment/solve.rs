//! The assignment problem by shortest augmenting paths (Jonker and Volgenant 1987, without their initialisation).

/// An assignment of least total cost, with the prices that prove it.
#[derive(Debug, Clone, PartialEq)]
pub struct Optimum {
    /// For each row its column.
    pub column_of: Vec<usize>,
    /// Sum of the chosen costs.
    pub cost: f64,
    /// Dual prices of rows and columns: row + column <= cost everywhere, with equality where assigned, and columns at
    /// most 0, with 0 where unused. By weak duality their sum is a lower bound of every assignment's cost.
    pub prices: (Vec<f64>, Vec<f64>),
}

/// Assigns each of `rows` rows to a column of its own among `columns`, at least as many, so that the sum of
/// `cost(row, column)` is least. The same costs give the same result: ties go to the lower column.
///
/// Costs must be finite. O(rows^2 columns).
pub fn solve(rows: usize, columns: usize, cost: impl Fn(usize, usize) -> f64) -> Optimum {
    assert!(rows <= columns, "every row needs a column of its own");
    let mut search = Search {
        row_price: vec![0.0; rows],
        column_price: vec![0.0; columns],
        row_of: vec![None; columns],
        distance: vec![0.0; columns],
        from: vec![None; columns],
        done: vec![false; columns],
    };
    for row in 0..rows {
        search.augment(row, &cost);
    }
    let mut column_of = vec![0; rows];
    for (column, row) in search.row_of.iter().enumerate() {
        if let Some(row) = *row {
            column_of[row] = column;
        }
    }
    let total = column_of.iter().enumerate().map(|(row, &column)| cost(row, column)).sum();
    Optimum { column_of, cost: total, prices: (search.row_price, search.column_price) }
}

struct Search {
    row_price: Vec<f64>,
    column_price: Vec<f64>,
    row_of: Vec<Option<usize>>,
    /// Reduced length of the shortest alternating path to each column.
    distance: Vec<f64>,
    /// The column before it on that path; none if the path comes from the new row.
    from: Vec<Option<usize>>,
    done: Vec<bool>,
}

impl Search {
    /// Gives `row` a column, moving others along the shortest alternating path.
    fn augment(&mut self, row: usize, cost: &impl Fn(usize, usize) -> f64) {
        self.distance.fill(f64::INFINITY);
        self.from.fill(None);
        self.done.fill(false);
        let (mut at_row, mut reached, mut previous) = (row, 0.0, None);
        let free = loop {
            self.relax(at_row, reached, previous, cost);
            let column = self.nearest();
            self.done[column] = true;
            reached = self.distance[column];
            match self.row_of[column] {
                None => break column,
                Some(next) => (at_row, previous) = (next, Some(column)),
            }
        };
        self.reprice(row, reached);
        self.flip(row, free);
    }

    fn relax(&mut self, row: usize, reached: f64, previous: Option<usize>, cost: &impl Fn(usize, usize) -> f64) {
        for column in 0..self.distance.len() {
            if self.done[column] {
                continue;
            }
            let length = reached + cost(row, column) - self.row_price[row] - self.column_price[column];
            if length < self.distance[column] {
                self.distance[column] = length;
                self.from[column] = previous;
            }
        }
    }

    fn nearest(&self) -> usize {
        let mut best = None;
        for column in 0..self.distance.len() {
            let nearer = |other: usize| self.distance[column] < self.distance[other];
            if !self.done[column] && best.is_none_or(nearer) {
                best = Some(column);
            }
        }
        // There are as many columns as rows, so one is always left; 0 keeps the search total.
        best.unwrap_or(0)
    }

    /// Keeps the prices feasible and tight along the path of length `reached`.
    fn reprice(&mut self, row: usize, reached: f64) {
        self.row_price[row] += reached;
        for column in 0..self.distance.len() {
            let slack = reached - self.distance[column];
            if let (true, Some(assigned)) = (self.done[column], self.row_of[column]) {
                self.row_price[assigned] += slack;
                self.column_price[column] -= slack;
            }
        }
    }

    fn flip(&mut self, row: usize, free: usize) {
        let mut column = free;
        while let Some(previous) = self.from[column] {
            self.row_of[column] = self.row_of[previous];
            column = previous;
        }
        self.row_of[column] = Some(row);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Least cost by trying all assignments.
    fn brute_force(costs: &[Vec<f64>], row: usize, used: &mut Vec<bool>) -> f64 {
        if row == costs.len() {
            return 0.0;
        }
        let mut best = f64::INFINITY;
        for column in 0..used.len() {
            if !used[column] {
                used[column] = true;
                best = best.min(costs[row][column] + brute_force(costs, row + 1, used));
                used[column] = false;
            }
        }
        best
    }

    fn matrix() -> impl Strategy<Value = Vec<Vec<f64>>> {
        (1_usize..7, 0_usize..3).prop_flat_map(|(rows, more)| {
            proptest::collection::vec(proptest::collection::vec(-10.0..10.0_f64, rows + more), rows)
        })
    }

    proptest! {
        #[test]
        fn nobody_does_better(costs in matrix()) {
            let columns = costs[0].len();
            let optimum = solve(costs.len(), columns, |row, column| costs[row][column]);
            let best = brute_force(&costs, 0, &mut vec![false; columns]);
            prop_assert!((optimum.cost - best).abs() < 1e-9, "{} instead of {best}", optimum.cost);
        }

        #[test]
        fn prices_prove_it(costs in matrix()) {
            let columns = costs[0].len();
            let Optimum { column_of, cost, prices: (row_price, column_price) } =
                solve(costs.len(), columns, |row, column| costs[row][column]);
            for (row, costs) in costs.iter().enumerate() {
                for (column, cost) in costs.iter().enumerate() {
                    prop_assert!(row_price[row] + column_price[column] <= cost + 1e-9);
                }
            }
            for (column, price) in column_price.iter().enumerate() {
                prop_assert!(*price <= 1e-12);
                prop_assert!(column_of.contains(&column) || *price == 0.0);
            }
            let bound: f64 = row_price.iter().chain(&column_price).sum();
            prop_assert!((bound - cost).abs() < 1e-9, "bound {bound}, cost {cost}");
        }
    }

    #[test]
    fn ties_go_to_the_lower_column() {
        assert_eq!(solve(3, 4, |_, _| 1.0).column_of, [0, 1, 2]);
    }

    #[test]
    fn nothing_to_assign() {
        assert_eq!(solve(0, 0, |_, _| 0.0).column_of, Vec::<usize>::new());
    }
}
