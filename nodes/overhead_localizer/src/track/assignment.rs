//! Optimal one-to-one assignment where some pairs are impossible.

use pathfinding::kuhn_munkres::kuhn_munkres;
use pathfinding::matrix::Matrix;

/// Costs are resolved to this fraction.
const RESOLUTION: f64 = 1e-6;

/// For each row the column it is matched with, such that the sum of gains is greatest. `gain` gives the gain of matching
/// a row with a column, None or zero where they cannot be matched.
pub(super) fn assign(rows: usize, columns: usize, gain: impl Fn(usize, usize) -> Option<f64>) -> Vec<Option<usize>> {
    if rows == 0 || columns == 0 {
        return vec![None; rows];
    }
    // Integers make the optimum exact. A gain of zero stands for "not matched": it never displaces a real one.
    let weight = |row, column| gain(row, column).map_or(0, |gain| (gain / RESOLUTION) as i64).max(0);
    // The algorithm wants at least as many columns as rows: matches with the surplus ones are none.
    let weights = Matrix::from_fn(
        rows,
        columns.max(rows),
        |(row, column)| {
            if column < columns { weight(row, column) } else { 0 }
        },
    );
    let (_, matched) = kuhn_munkres(&weights);
    let real = |(row, column): (usize, usize)| (weights[(row, column)] > 0).then_some(column);
    matched.into_iter().enumerate().map(real).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_greatest_sum() {
        let check = |gains: &[&[f64]], expected: &[Option<usize>]| {
            let columns = gains.first().map_or(0, |row| row.len());
            let result =
                assign(gains.len(), columns, |row, column| Some(gains[row][column]).filter(|gain| *gain > 0.0));
            assert_eq!(result, expected, "{gains:?}");
        };
        check(&[], &[]);
        check(&[&[], &[]], &[None, None]);
        check(&[&[1.0, 0.0], &[2.0, 0.0]], &[None, Some(0)]);
        check(&[&[5.0, 4.0], &[4.0, 1.0]], &[Some(1), Some(0)]);
        check(&[&[3.0], &[3.5], &[1.0]], &[None, Some(0), None]);
        check(&[&[0.0, 0.0, 2.0], &[0.0, 1.0, 0.0]], &[Some(2), Some(1)]);
    }
}
