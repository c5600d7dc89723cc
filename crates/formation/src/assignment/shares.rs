//! How many robots each queue gets.

/// Splits `robots` robots among queues by their `shares` (C of Definition 2.1.1), by largest remainders: each queue gets
/// the whole part of its share, and the robots left go to the largest fractions, the earlier queue first among equals.
pub fn split(robots: usize, shares: &[f64]) -> Vec<usize> {
    let total: f64 = shares.iter().sum();
    let ideal = |share: f64| if total > 0.0 { robots as f64 * share / total } else { 0.0 };
    // A third written as 0.3333 must still be one robot of three.
    let whole = |share: f64| libm::floor(ideal(share) + 1e-2);
    let mut counts: Vec<usize> = shares.iter().map(|&share| whole(share) as usize).collect();
    let mut order: Vec<usize> = (0..shares.len()).collect();
    let remainder = |queue: usize| ideal(shares[queue]) - counts[queue] as f64;
    order.sort_by(|&a, &b| remainder(b).total_cmp(&remainder(a)));
    let left = robots.saturating_sub(counts.iter().sum());
    for &queue in order.iter().cycle().take(if shares.is_empty() { 0 } else { left }) {
        counts[queue] += 1;
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn largest_remainders() {
        let check = |robots, shares: &[f64], expected: &[usize]| assert_eq!(split(robots, shares), expected);
        check(4, &[0.5, 0.5], &[2, 2]);
        check(3, &[0.3333, 0.3333, 0.3334], &[1, 1, 1]);
        check(5, &[0.5, 0.5], &[3, 2]);
        check(10, &[0.25, 0.25, 0.5], &[3, 2, 5]);
        check(3, &[1.0], &[3]);
        check(0, &[0.5, 0.5], &[0, 0]);
        check(7, &[], &[]);
    }

    proptest! {
        #[test]
        fn everybody_gets_a_queue_and_no_queue_is_far_off(
            robots in 0_usize..40, shares in proptest::collection::vec(0.05..1.0_f64, 1..6),
        ) {
            let counts = split(robots, &shares);
            prop_assert_eq!(counts.iter().sum::<usize>(), robots);
            let total: f64 = shares.iter().sum();
            for (count, share) in counts.iter().zip(&shares) {
                prop_assert!((*count as f64 - robots as f64 * share / total).abs() < 1.02);
            }
        }
    }
}
