//! Damping functions that a person writes down, as a formula or a table: Corollary A.9.1 makes trenches of them.
use super::admissibility::{NEAREST, first_unproved};
use super::{Damping, Interval, Meaning, SlopeTable, Slopes, TableError, Trench, Written, WrittenError};
use std::sync::Arc;
use trench_expression::Expression;

/// k(x) from an expression in x (m), proved to be bounded and, but at 0, positive on [-range, range]. Beyond, k stays what it is at the ends.
/// Bounded as it is, the integral of 1/K diverges at 0: it is at least that of 1/(M x), M the bound.
#[derive(Debug, Clone, PartialEq)]
pub struct WrittenDamping(Arc<Written>);

/// k(|x|) from a table, linear between its rows; two rows of one x make a jump, beyond the last row k stays.
#[derive(Debug, Clone, PartialEq)]
pub struct TableDamping(Arc<SlopeTable>);

/// What is no damping.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DampingError {
    /// See [`WrittenError`].
    #[error(transparent)]
    Written(#[from] WrittenError),
    /// See [`TableError`].
    #[error(transparent)]
    Table(#[from] TableError),
    /// k is not positive, or that cannot be proved.
    #[error("the damping is {coefficient} 1/s at x = {x}; it must be positive but at 0 (Corollary A.9.1)")]
    NotPositive {
        /// Metres.
        x: f64,
        /// 1/s.
        coefficient: f64,
    },
    /// Bounds on 200,000 intervals did not settle it.
    #[error(
        "that the damping is positive (Corollary A.9.1) could not be proved up to x = {range}: it comes near 0 where its formula takes \
         large terms from each other; write it without them, or as a table"
    )]
    Unproved {
        /// Metres.
        range: f64,
    },
}

impl WrittenDamping {
    /// The damping that `function` is on [-range, range] (m).
    ///
    /// # Errors
    /// Where it is not finite or, elsewhere than at 0, not positive; when it has too many kinks.
    pub fn new(function: Expression, range: f64) -> Result<Self, DampingError> {
        let written = Written::new(function, Meaning::Slope, range)?;
        let positive = |_: f64, bounds: Interval| bounds.low;
        match first_unproved(|low, high| written.slope_bounds(low, high), positive, range) {
            Ok(Some(_)) => {}
            Ok(None) => return Err(DampingError::Unproved { range }),
            Err(x) => return Err(DampingError::NotPositive { x, coefficient: written.slopes(x).gradient().low }),
        }
        // Nearer to 0 than proofs begin, where its formula may be anything.
        for x in [NEAREST * range, -NEAREST * range, f64::MIN_POSITIVE, -f64::MIN_POSITIVE] {
            let coefficient = written.slopes(x).gradient().low;
            if coefficient < 0.0 {
                return Err(DampingError::NotPositive { x, coefficient });
            }
        }
        Ok(Self(Arc::new(written)))
    }
}

impl Damping for WrittenDamping {
    fn coefficient(&self, x: f64) -> f64 {
        self.0.slopes(x).right
    }

    fn coefficients(&self, x: f64) -> Slopes {
        self.0.slopes(x)
    }

    fn integral(&self, x: f64) -> f64 {
        self.0.value(x)
    }

    fn kinks(&self) -> Vec<f64> {
        self.0.kinks()
    }

    fn bounds(&self, low: f64, high: f64) -> Option<Interval> {
        self.0.slope_bounds(low, high)
    }
}

impl TableDamping {
    /// From rows of x (m), from 0 on, and k (1/s).
    ///
    /// # Errors
    /// See [`SlopeTable::new`]; rows in which k is not positive, elsewhere than at 0.
    pub fn new(rows: Vec<(f64, f64)>) -> Result<Self, DampingError> {
        let last = rows.len().saturating_sub(1);
        let wrong = |&(index, (x, k)): &(usize, (f64, f64))| k < 0.0 || (k == 0.0 && (x > 0.0 || index == last));
        let found = rows.iter().copied().enumerate().find(wrong).map(|(_, row)| row);
        let table = SlopeTable::new(rows)?;
        match found {
            Some((x, coefficient)) => Err(DampingError::NotPositive { x, coefficient }),
            None => Ok(Self(Arc::new(table))),
        }
    }
}

impl Damping for TableDamping {
    fn coefficient(&self, x: f64) -> f64 {
        self.0.slopes(x.abs()).right
    }

    fn coefficients(&self, x: f64) -> Slopes {
        let slopes = self.0.slopes(x.abs());
        // The table goes on as an odd function, k as an even one.
        if x == 0.0 {
            Slopes::smooth(slopes.right)
        } else if x < 0.0 {
            Slopes { left: slopes.right, right: slopes.left }
        } else {
            slopes
        }
    }

    fn integral(&self, x: f64) -> f64 {
        self.0.value(x).copysign(x)
    }

    fn kinks(&self) -> Vec<f64> {
        self.0.kinks()
    }

    fn bounds(&self, low: f64, high: f64) -> Option<Interval> {
        let (low, high) = if low >= 0.0 { (low, high) } else { (0.0_f64.max(-high), high.max(-low)) };
        let bounds = self.0.slope_bounds(low, high)?;
        Some(Interval { low: bounds.low.max(0.0), high: bounds.high })
    }
}

#[cfg(test)]
mod tests {
    use super::super::*;
    use super::*;

    fn written(text: &str) -> Result<WrittenDamping, DampingError> {
        WrittenDamping::new(Expression::parse(text).unwrap(), 20.0)
    }

    /// The examples of A.9, written down, are the built-in ones: damping, integral, and the trench that they make.
    #[test]
    fn written_dampings_are_the_built_in_ones() {
        let same = |written: &dyn Damping, built_in: &dyn Damping| {
            let trenches = (CriticallyDamped(written), CriticallyDamped(built_in));
            for index in -200..=200 {
                let x = 0.1 * f64::from(index);
                let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (1.0 + b.abs());
                assert!(near(written.coefficient(x), built_in.coefficient(x)), "{x}");
                assert!(near(written.integral(x), built_in.integral(x)), "{x}");
                assert!(near(trenches.0.value(x), trenches.1.value(x)), "{x}");
                assert!(near(trenches.0.slope(x), trenches.1.slope(x)), "{x}");
            }
        };
        let hyperbolic = HyperbolicDamping { alpha: 2.0, a: 0.5 };
        same(&written("2").unwrap(), &ConstantDamping { coefficient: 2.0 });
        same(&written("2*abs(x)/sqrt(x^2 + 0.5^2)").unwrap(), &hyperbolic);
        same(&written("2*min(abs(x), 1)/sqrt(min(abs(x), 1)^2 + 0.5^2)").unwrap(), &SaturatedDamping(hyperbolic));
        same(&TableDamping::new(vec![(0.0, 2.0)]).unwrap(), &ConstantDamping { coefficient: 2.0 });
        same(&TableDamping::new(vec![(0.0, 0.0), (1.0, 3.0)]).unwrap(), &written("3*min(abs(x), 1)").unwrap());
    }

    /// Trenches of dampings that rise and fall are proved admissible, or refused where they are not.
    #[test]
    fn trenches_of_written_dampings_are_judged_by_bounds() {
        let judged = |text: &str| check_admissibility(&CriticallyDamped(written(text).unwrap()), 20.0);
        let falling = judged("1 + exp(-x^2)").unwrap();
        assert!(falling.proved_from.is_some_and(|from| from < 1e-7), "{falling:?}");
        // A damping that falls at once makes a kink that points upward.
        let stepped = judged("2 + sign(sqrt(2) - abs(x))");
        assert!(
            matches!(stepped, Err(Inadmissible::NotRegular { x, .. }) if (x.abs() - core::f64::consts::SQRT_2).abs() < 1e-8)
        );
        assert!(judged("2 - sign(sqrt(2) - abs(x))").is_ok());
        let table = TableDamping::new(vec![(0.0, 0.5), (1.0, 0.5), (1.0, 2.0), (3.0, 1.0)]).unwrap();
        let found = check_admissibility(&CriticallyDamped(table), 20.0).unwrap();
        assert!(found.proved_from.is_some(), "{found:?}");
        assert!(found.lipschitz_constant >= 0.25 * (0.5 + 3.0 + 17.0), "{found:?}");
    }

    #[test]
    fn what_is_no_damping() {
        let check = |found: Result<(), DampingError>, expected: &str| {
            let text = found.unwrap_err().to_string();
            assert!(text.contains(expected), "{text}");
        };
        check(written("x").map(drop), "it must be positive but at 0 (Corollary A.9.1)");
        check(written("1 - x^2/100").map(drop), "at x = ");
        check(written("1/abs(x)").map(drop), "is not finite at x = 0");
        check(written("0*x").map(drop), "the damping is 0 1/s");
        // Positive, but of intervals it would take 1e10 and more to see that.
        check(written("1e-9 + x^2 - x*x").map(drop), "could not be proved up to x = ");
        let table = |rows: &[(f64, f64)]| TableDamping::new(rows.to_vec()).map(drop);
        check(table(&[(0.0, 1.0), (2.0, 0.0)]), "the damping is 0 1/s at x = 2");
        check(table(&[(0.0, 0.0)]), "the damping is 0 1/s at x = 0");
        check(table(&[(0.0, 1.0), (1.0, -1.0)]), "the damping is -1 1/s at x = 1");
        check(table(&[(0.5, 1.0)]), "begins at x = 0.5");
        assert!(table(&[(0.0, 0.0), (1.0, 2.0)]).is_ok());
    }
}
