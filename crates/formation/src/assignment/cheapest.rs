//! The cheapest columns of a row, in vector code: most of the time of an assignment whose prices are nearly right.
use crate::lanes::{LANES, Lanes, first_at};

/// The least and second least reduced cost of a row, the latter infinite where there is one column alone, and the first column at
/// the least.
pub(super) struct Cheapest {
    pub(super) first: f64,
    pub(super) second: f64,
    pub(super) column: usize,
}

/// Of a row's costs under the prices `v` of the columns.
#[inline(always)]
pub(super) fn cheapest<L: Lanes>(costs: &[f64], v: &[f64]) -> Cheapest {
    let ((costs_lanes, costs_rest), (v_lanes, v_rest)) = (costs.as_chunks::<LANES>(), v.as_chunks::<LANES>());
    let (mut firsts, mut seconds) = (L::splat(f64::INFINITY), L::splat(f64::INFINITY));
    for (costs, v) in costs_lanes.iter().zip(v_lanes) {
        let reduced = L::new(*costs) - L::new(*v);
        seconds = seconds.least(firsts.most(reduced));
        firsts = firsts.least(reduced);
    }
    let (mut first, mut second) = (f64::INFINITY, f64::INFINITY);
    let mut take = |reduced: f64| {
        let greater = if reduced > first { reduced } else { first };
        first = if reduced < first { reduced } else { first };
        second = if greater < second { greater } else { second };
    };
    firsts.to_array().into_iter().chain(seconds.to_array()).for_each(&mut take);
    costs_rest.iter().zip(v_rest).for_each(|(cost, v)| take(cost - v));
    Cheapest { first, second, column: next_at::<L>(costs, v, 0, first).unwrap_or(0) }
}

/// The first column, from `begin` on, at a reduced cost.
#[inline(always)]
pub(super) fn next_at<L: Lanes>(costs: &[f64], v: &[f64], begin: usize, reduced: f64) -> Option<usize> {
    let (costs, v) = (costs.get(begin..)?, v.get(begin..)?);
    let ((costs_lanes, costs_rest), (v_lanes, v_rest)) = (costs.as_chunks::<LANES>(), v.as_chunks::<LANES>());
    let all = costs_lanes.iter().zip(v_lanes).map(|(costs, v)| L::new(*costs) - L::new(*v));
    let in_rest = || costs_rest.iter().zip(v_rest).position(|(cost, v)| cost - v == reduced);
    let found = first_at(all, reduced).or_else(|| Some(LANES * costs_lanes.len() + in_rest()?));
    found.map(|column| begin + column)
}

#[cfg(test)]
mod tests {
    use super::*;
    use wide::f64x4;

    #[test]
    fn as_one_column_after_the_other() {
        let mut state = 1_u64;
        for columns in 1..40 {
            // Few values, so that many are equal.
            let mut values = || -> Vec<f64> {
                let mut draw = || {
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                    ((state >> 60) as f64) * 0.1
                };
                (0..columns).map(|_| draw()).collect()
            };
            let (costs, v) = (values(), values());
            let reduced: Vec<f64> = costs.iter().zip(&v).map(|(cost, v)| cost - v).collect();
            let mut sorted = reduced.clone();
            sorted.sort_by(f64::total_cmp);
            let found = cheapest::<f64x4>(&costs, &v);
            let column = reduced.iter().position(|value| *value == sorted[0]);
            assert_eq!((found.first, Some(found.column)), (sorted[0], column));
            assert_eq!(found.second, sorted.get(1).copied().unwrap_or(f64::INFINITY));
            let next = reduced.iter().skip(found.column + 1).position(|value| *value == sorted[0]);
            let next = next.map(|later| found.column + 1 + later);
            assert_eq!(next_at::<f64x4>(&costs, &v, found.column + 1, found.first), next);
        }
    }
}
