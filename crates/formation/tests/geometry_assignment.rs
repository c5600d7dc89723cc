//! Assignments against all permutations, with their certificates.
#![expect(clippy::unwrap_used, reason = "a failed construction is a failed test")]
use proptest::prelude::*;
use trench_formation::Vector2;
use trench_formation::assignment::{
    AssignmentError, CostMatrix, Hysteresis, assign_to_queues, reassign, robots_per_queue, solve, solve_again,
};

const NONE: Hysteresis = Hysteresis { relative: 0.0, absolute: 0.0 };

/// Least total cost over all ways to give the rows from `row` on the columns that are not taken.
fn cheapest(costs: &CostMatrix, row: usize, taken: u32) -> f64 {
    if row == costs.rows() {
        return 0.0;
    }
    let free = (0..costs.columns()).filter(|column| taken & (1 << column) == 0);
    free.map(|column| costs.at(row, column) + cheapest(costs, row + 1, taken | 1 << column))
        .fold(f64::INFINITY, f64::min)
}

fn matrices() -> impl Strategy<Value = CostMatrix> {
    (1..7_usize, 0..3_usize, 1..50_u32).prop_flat_map(|(rows, spare, coarse)| {
        let columns = (rows + spare).min(7);
        let values = prop::collection::vec(0..coarse, rows * columns);
        values.prop_map(move |values| {
            CostMatrix::new(values.into_iter().map(f64::from).collect(), rows, columns).unwrap()
        })
    })
}

proptest! {
    #[test]
    fn the_optimum_equals_brute_force_and_proves_itself(costs in matrices()) {
        let optimum = solve(&costs).unwrap();
        prop_assert_eq!(optimum.total, cheapest(&costs, 0, 0));
        prop_assert_eq!(optimum.violation(&costs), 0.0);
        let mut columns = optimum.columns.clone();
        columns.sort_unstable();
        columns.dedup();
        prop_assert_eq!(columns.len(), costs.rows());
    }

    /// A start from what was best for other costs finds what is best, and proves it.
    #[test]
    fn optima_are_found_again(before in matrices(), after in matrices()) {
        let again = solve_again(&after, &solve(&before).unwrap()).unwrap();
        prop_assert_eq!(again.total, solve(&after).unwrap().total);
        prop_assert_eq!(again.violation(&after), 0.0);
    }

    #[test]
    fn large_optima_are_found_again(
        values in prop::collection::vec(0.0..9.0_f64, 30 * 30),
        changes in prop::collection::vec(-0.1..0.1_f64, 30 * 30),
    ) {
        for rows in [24, 30] {
            let part = |values: &[f64]| CostMatrix::new(values[..rows * 30].to_vec(), rows, 30).unwrap();
            let before = part(&values);
            let changed: Vec<f64> = values.iter().zip(&changes).map(|(value, change)| value + change).collect();
            let after = part(&changed);
            let again = solve_again(&after, &solve(&before).unwrap()).unwrap();
            prop_assert!(again.violation(&after) < 1e-12);
            prop_assert!((again.total - solve(&after).unwrap().total).abs() < 1e-12);
        }
    }

    #[test]
    fn large_optima_prove_themselves(values in prop::collection::vec(0.0..9.0_f64, 40 * 50)) {
        let costs = CostMatrix::new(values, 40, 50).unwrap();
        prop_assert!(solve(&costs).unwrap().violation(&costs) < 1e-12);
    }

    #[test]
    fn all_robots_get_a_place(weights in prop::collection::vec(1..100_u32, 1..8), robots in 0..50_usize) {
        let sum: u32 = weights.iter().sum();
        let shares: Vec<f64> = weights.iter().map(|weight| f64::from(*weight) / f64::from(sum)).collect();
        let counts = robots_per_queue(&shares, robots).unwrap();
        prop_assert_eq!(counts.iter().sum::<usize>(), robots);
        for (count, share) in counts.iter().zip(&shares) {
            prop_assert!((*count as f64 - share * robots as f64).abs() < 1.0);
        }
    }
}

#[test]
fn shares_go_by_the_largest_remainder() {
    let check = |shares: &[f64], robots, expected: &[usize]| {
        assert_eq!(robots_per_queue(shares, robots).unwrap(), expected, "{shares:?} {robots}");
    };
    check(&[0.5, 0.5], 5, &[3, 2]);
    check(&[0.2, 0.5, 0.3], 4, &[1, 2, 1]);
    check(&[1.0 / 3.0; 3], 3, &[1, 1, 1]);
    check(&[1.0, 0.0], 3, &[3, 0]);
    check(&[0.4, 0.6], 0, &[0, 0]);
    assert_eq!(robots_per_queue(&[0.5, 0.4], 3), Err(AssignmentError::ShareSum(0.9)));
    assert!(matches!(robots_per_queue(&[1.5, -0.5], 3), Err(AssignmentError::Share { queue: 1, .. })));
    assert!(robots_per_queue(&[f64::NAN], 3).is_err());
}

#[test]
fn a_small_gain_does_not_swap_robots() {
    let costs = CostMatrix::new(vec![1.0, 0.9, 0.9, 1.0], 2, 2).unwrap();
    let keep = |relative, absolute| reassign(&costs, &[0, 1], Hysteresis { relative, absolute }).unwrap() == [0, 1];
    assert!(keep(0.2, 0.0) && keep(0.0, 0.3) && keep(0.05, 0.3) && keep(0.2, 0.1));
    assert!(!keep(0.05, 0.1));
    assert_eq!(reassign(&costs, &[], NONE).unwrap(), [1, 0], "nothing to keep");
    assert_eq!(reassign(&costs, &[0, 0], Hysteresis { relative: 9.0, absolute: 9.0 }).unwrap(), [1, 0]);
}

#[test]
fn robots_go_to_the_nearest_queues_with_room() {
    let distances = CostMatrix::new(vec![1.0, 9.0, 2.0, 4.0, 1.5, 8.0], 3, 2).unwrap();
    let counts = robots_per_queue(&[0.5, 0.5], 3).unwrap();
    assert_eq!(assign_to_queues(&distances, &counts, &[], NONE).unwrap(), [0, 1, 0]);
    let much = Hysteresis { relative: 0.9, absolute: 0.0 };
    assert_eq!(assign_to_queues(&distances, &counts, &[1, 0, 0], much).unwrap(), [1, 0, 0]);
    assert_eq!(assign_to_queues(&distances, &counts, &[1, 1, 1], much).unwrap(), [0, 1, 0], "queue 1 has one place");
    assert!(matches!(assign_to_queues(&distances, &[1, 1], &[], NONE), Err(AssignmentError::TooFewPlaces { .. })));
    assert!(CostMatrix::new(vec![f64::NAN], 1, 1).is_err() && CostMatrix::new(vec![1.0], 2, 1).is_err());
    let (robots, places) =
        ([Vector2::new(1.0, 2.0), Vector2::new(0.0, 0.0)], [Vector2::new(4.0, 6.0), Vector2::new(1.0, 2.0)]);
    let squares = CostMatrix::new(vec![25.0, 0.0, 52.0, 5.0], 2, 2);
    assert_eq!(CostMatrix::squared_distances(&robots, &places), squares);
    let lost = CostMatrix::squared_distances(&robots, &[Vector2::new(0.0, f64::NAN)]);
    assert!(matches!(lost, Err(AssignmentError::NotFinite { row: 0, column: 0, .. })));
    let far = CostMatrix::squared_distances(&robots, &[places[0], Vector2::new(1e200, 0.0)]);
    assert!(matches!(far, Err(AssignmentError::NotFinite { row: 0, column: 1, .. })));
}
