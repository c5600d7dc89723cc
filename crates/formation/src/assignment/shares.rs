//! How many robots each queue gets (Definition 2.1.1).
use super::AssignmentError;

/// Divides `robots` among queues by their capacity shares, by the method of the largest remainder: each queue gets the
/// whole part of its quota, and what is left over goes to the largest fractions, to the earlier queue if equal.
///
/// # Errors
/// Shares that are negative, not finite, or do not add up to 1 within 1e-6.
pub fn robots_per_queue(shares: &[f64], robots: usize) -> Result<Vec<usize>, AssignmentError> {
    if let Some(queue) = shares.iter().position(|share| !(share.is_finite() && *share >= 0.0)) {
        return Err(AssignmentError::Share { queue, value: shares[queue] });
    }
    let sum: f64 = shares.iter().sum();
    if (sum - 1.0).abs() > 1e-6 {
        return Err(AssignmentError::ShareSum(sum));
    }
    let quotas: Vec<f64> = shares.iter().map(|share| share / sum * robots as f64).collect();
    // A quota that is whole but for rounding (3 * (1/3)) must not lose its last robot to a remainder of 1e-16.
    let whole: Vec<f64> = quotas.iter().map(|quota| libm::floor(quota + 1e-9)).collect();
    let mut counts: Vec<usize> = whole.iter().map(|count| *count as usize).collect();
    let mut order: Vec<usize> = (0..shares.len()).collect();
    order.sort_by(|a, b| {
        let (first, second) = (quotas[*a] - whole[*a], quotas[*b] - whole[*b]);
        if (first - second).abs() <= 1e-9 { a.cmp(b) } else { second.total_cmp(&first) }
    });
    let left = robots.saturating_sub(counts.iter().sum());
    for queue in order.into_iter().filter(|queue| shares[*queue] > 0.0).take(left) {
        counts[queue] += 1;
    }
    Ok(counts)
}
