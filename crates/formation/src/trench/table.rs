//! A trench from a table of its slope: Lemma 5.2.1 as a constructor.
use super::{Interval, Slopes, Trench};

/// Phi(x) = integral of phi from 0 to |x|, phi given by points between which it is linear. Two points of one x make a
/// jump of the slope, a kink of Phi; beyond the last point the slope stays. phi is continued as an odd function.
#[derive(Debug, Clone, PartialEq)]
pub struct SlopeTable {
    points: Vec<(f64, f64)>,
    /// Phi at each point.
    values: Vec<f64>,
}

/// Why a table is no slope.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TableError {
    /// There is nothing in it.
    #[error("the table has no points; it needs at least one, at x = 0")]
    Empty,
    /// It begins elsewhere.
    #[error("the table begins at x = {0}; it must begin at x = 0")]
    Start(f64),
    /// Not numbers.
    #[error("row {row} has the values ({x}, {slope}); both must be finite")]
    NotFinite {
        /// From 1.
        row: usize,
        /// Metres.
        x: f64,
        /// m/s^2.
        slope: f64,
    },
    /// x falls, or stands three times.
    #[error("row {row} has x = {x}: x must not fall, and one x may stand twice at most (a jump of the slope)")]
    Order {
        /// From 1.
        row: usize,
        /// Metres.
        x: f64,
    },
}

impl SlopeTable {
    /// From points (x in metres, slope in m/s^2) with x from 0 on.
    ///
    /// # Errors
    /// When the points are none, not finite or not in order.
    pub fn new(points: Vec<(f64, f64)>) -> Result<Self, TableError> {
        for (index, &(x, slope)) in points.iter().enumerate() {
            let row = index + 1;
            if !x.is_finite() || !slope.is_finite() {
                return Err(TableError::NotFinite { row, x, slope });
            }
            let falls = index >= 1 && x < points[index - 1].0;
            let triple = index >= 2 && x == points[index - 2].0;
            if falls || triple {
                return Err(TableError::Order { row, x });
            }
        }
        match points.first() {
            None => return Err(TableError::Empty),
            Some(&(x, _)) if x != 0.0 => return Err(TableError::Start(x)),
            Some(_) => {}
        }
        let mut values = vec![0.0];
        for pair in points.windows(2) {
            let area = 0.5 * (pair[1].0 - pair[0].0) * (pair[0].1 + pair[1].1);
            values.push(values[values.len() - 1] + area);
        }
        Ok(Self { points, values })
    }

    /// The slope at `x` >= 0 by linear interpolation from point `index` on, and Phi there.
    fn along(&self, index: usize, x: f64) -> (f64, f64) {
        let (start, slope) = self.points[index];
        let grade = match self.points.get(index + 1) {
            Some(&(end, next)) if end > start => (next - slope) / (end - start),
            _ => 0.0,
        };
        let step = x - start;
        (slope + grade * step, self.values[index] + step * (slope + 0.5 * grade * step))
    }
}

impl Trench for SlopeTable {
    fn value(&self, x: f64) -> f64 {
        let size = x.abs();
        let index = self.points.partition_point(|point| point.0 <= size) - 1;
        self.along(index, size).1
    }

    fn slopes(&self, x: f64) -> Slopes {
        let size = x.abs();
        let outer = self.along(self.points.partition_point(|point| point.0 <= size) - 1, size).0;
        let before = self.points.partition_point(|point| point.0 < size);
        let inner = if before == 0 { -self.points[0].1 } else { self.along(before - 1, size).0 };
        if x == 0.0 {
            Slopes { left: -outer, right: outer }
        } else if x > 0.0 {
            Slopes { left: inner, right: outer }
        } else {
            Slopes { left: -outer, right: -inner }
        }
    }

    fn kinks(&self) -> Vec<f64> {
        let jumps = self.points.windows(2).filter(|pair| pair[0].0 == pair[1].0).map(|pair| pair[0].0);
        let mut kinks: Vec<f64> = jumps.flat_map(|x| [-x, x]).chain([0.0]).collect();
        kinks.sort_by(f64::total_cmp);
        kinks.dedup();
        kinks
    }

    fn slope_bounds(&self, low: f64, high: f64) -> Option<Interval> {
        let ends = [self.slopes(low).left, self.slopes(low).right, self.slopes(high).left, self.slopes(high).right];
        let corners = self.points.iter().flat_map(|&(x, _)| [x, -x]).filter(|x| (low..=high).contains(x));
        let inner = corners.flat_map(|x| [self.slopes(x).left, self.slopes(x).right]);
        let hull = |all: Interval, slope: f64| Interval { low: all.low.min(slope), high: all.high.max(slope) };
        Some(ends.into_iter().chain(inner).fold(Interval { low: f64::INFINITY, high: f64::NEG_INFINITY }, hull))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrates_and_jumps() {
        // f_1 of Example 5.2.3: 4x up to 1, then 1.
        let table = SlopeTable::new(vec![(0.0, 0.0), (1.0, 4.0), (1.0, 1.0)]).unwrap();
        for (x, value) in [(0.0, 0.0), (0.5, 0.5), (1.0, 2.0), (3.0, 4.0), (-3.0, 4.0)] {
            assert!((table.value(x) - value).abs() < 1e-15, "{x}");
        }
        assert_eq!(table.slopes(1.0), Slopes { left: 4.0, right: 1.0 });
        assert_eq!(table.slopes(-1.0), Slopes { left: -1.0, right: -4.0 });
        assert_eq!(table.slopes(-0.5), Slopes::smooth(-2.0));
        assert_eq!(table.kinks(), [-1.0, 0.0, 1.0]);
    }

    fn check(points: &[(f64, f64)], expected: &str) {
        let error = SlopeTable::new(points.to_vec()).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }

    #[test]
    fn bad_tables() {
        check(&[], "no points");
        check(&[(0.5, 1.0)], "begins at x = 0.5");
        check(&[(0.0, 1.0), (1.0, f64::NAN)], "row 2");
        check(&[(0.0, 1.0), (2.0, 1.0), (1.0, 1.0)], "row 3");
        check(&[(0.0, 1.0), (1.0, 1.0), (1.0, 2.0), (1.0, 3.0)], "row 4");
    }
}
