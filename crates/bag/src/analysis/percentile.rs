//! How values are spread.

use serde::Serialize;

/// Of many values: the middle, the 99th of a hundred, the largest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    /// Half of the values are no larger.
    pub p50: f64,
    /// 99 of a hundred are no larger.
    pub p99: f64,
    /// None is larger.
    pub max: f64,
}

impl Spread {
    /// Nothing of no values; values that are no numbers are left out.
    pub(super) fn of(mut values: Vec<f64>) -> Option<Self> {
        values.retain(|value| value.is_finite());
        values.sort_by(f64::total_cmp);
        // The nearest rank: a value that was there.
        let rank = |share: f64| values.get((values.len() as f64 * share).ceil().max(1.0) as usize - 1).copied();
        Some(Self { p50: rank(0.5)?, p99: rank(0.99)?, max: *values.last()? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_values_that_were_there() {
        let of = |count: u32| Spread::of((1..=count).rev().map(f64::from).collect());
        assert_eq!(of(0), None);
        assert_eq!(of(1), Some(Spread { p50: 1.0, p99: 1.0, max: 1.0 }));
        assert_eq!(of(200), Some(Spread { p50: 100.0, p99: 198.0, max: 200.0 }));
        assert_eq!(Spread::of(vec![f64::NAN, 3.0]), Some(Spread { p50: 3.0, p99: 3.0, max: 3.0 }));
    }
}
