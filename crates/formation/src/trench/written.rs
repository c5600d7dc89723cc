//! Trenches that a person writes down as a formula: Phi(x), or its slope phi(x).
use super::{Interval, Slopes, Trench};
use crate::quadrature::integral;
use trench_expression::{Expression, Rough, Roughness};

/// Most places at which the slope of a trench may jump or have a corner.
const MOST_KINKS: usize = 64;
/// To this share of 1 + |Phi| an integral and that of its halves must agree.
const AGREEMENT: f64 = 1e-12;
const MOST_SPLITS: u32 = 24;

/// Which function the formula is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    /// Phi(x), m^2/s^2.
    Potential,
    /// phi(x) = Phi'(x), m/s^2; Phi is its integral from 0.
    Slope,
}

/// A trench from an expression in x (m), proved to be finite and locally Lipschitz on [-range, range]. Beyond, the slope
/// stays what it is at the ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Written {
    function: Expression,
    meaning: Meaning,
    range: f64,
    /// Where it is not smooth, in order: kinks, and corners of the slope.
    kinks: Vec<Rough>,
    /// Of a slope: places between which it is smooth, and Phi there.
    integrals: Vec<(f64, f64)>,
}

/// A formula that is no trench.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WrittenError {
    /// The range is none.
    #[error("the range is {0} m, but must be positive and finite")]
    Range(f64),
    /// Not finite, or not Lipschitz.
    #[error("`{expression}` {problem} at x = {x} ({cause} at column {column})")]
    Rough {
        /// The formula.
        expression: String,
        /// What is wrong.
        problem: &'static str,
        /// Where, m.
        x: f64,
        /// What in the formula causes it.
        cause: &'static str,
        /// Where that stands, from 1.
        column: usize,
    },
    /// Hardly a trench.
    #[error("`{expression}` has more than {MOST_KINKS} kinks within {range} m")]
    ManyKinks {
        /// The formula.
        expression: String,
        /// Where it was looked at, m.
        range: f64,
    },
}

impl Written {
    /// The trench that `function` is on [-range, range] (m).
    ///
    /// # Errors
    /// Where it is not finite or not Lipschitz, and when it has too many kinks.
    pub fn new(function: Expression, meaning: Meaning, range: f64) -> Result<Self, WrittenError> {
        if !(range.is_finite() && range > 0.0) {
            return Err(WrittenError::Range(range));
        }
        let kinks = function.rough_points(-range, range, MOST_KINKS + 1);
        let problem = |rough: &Rough| match (rough.roughness, meaning) {
            (Roughness::Value, _) => Some("is not finite"),
            (Roughness::Slope, Meaning::Potential) => Some("jumps or is infinitely steep"),
            // A kink is shown by slopes that stay bounded across it.
            _ => (!enclosed(&function, meaning, rough.low, rough.high).is_bounded()).then_some("is infinitely steep"),
        };
        if let Some((rough, problem)) = kinks.iter().find_map(|rough| Some((rough, problem(rough)?))) {
            let (expression, x) = (function.source().to_owned(), function.shown(rough));
            return Err(WrittenError::Rough { expression, problem, x, cause: rough.cause, column: rough.column });
        }
        if kinks.len() > MOST_KINKS {
            return Err(WrittenError::ManyKinks { expression: function.source().to_owned(), range });
        }
        let mut written = Self { function, meaning, range, kinks, integrals: Vec::new() };
        if meaning == Meaning::Slope {
            written.integrals = written.integrate();
        }
        Ok(written)
    }

    /// The formula, and which function it is.
    pub fn formula(&self) -> (&str, Meaning) {
        (self.function.source(), self.meaning)
    }

    /// The slope at x on one side of it, within the range.
    fn one_sided(&self, x: f64, from_left: bool) -> f64 {
        let series = if from_left { self.function.series_from_left::<2>(x) } else { self.function.series::<f64, 2>(x) };
        series.0[usize::from(self.meaning == Meaning::Potential)]
    }

    /// The slopes before and behind a kink: at the ends of the stretch that it lies in. A fall between them that a steadily falling slope
    /// makes over this stretch, too, is none at a place.
    fn across(&self, kink: &Rough) -> Slopes {
        let (left, right) = (self.one_sided(kink.low, true), self.one_sided(kink.high, false));
        let order = 1 + usize::from(self.meaning == Meaning::Potential);
        let before = self.function.series_from_left::<3>(kink.low).derivative(order);
        let behind = self.function.series::<f64, 3>(kink.high).derivative(order);
        let steady = (kink.high - kink.low) * before.abs().max(behind.abs()) * 2.0;
        if left > right && left - right <= steady {
            Slopes::smooth(0.5 * (left + right))
        } else {
            Slopes { left, right }
        }
    }

    /// Phi at the ends of stretches over which the quadrature is exact but for rounding.
    fn integrate(&self) -> Vec<(f64, f64)> {
        let mut ends: Vec<f64> = self.kinks.iter().map(|kink| 0.5 * (kink.low + kink.high)).collect();
        ends.extend([-self.range, 0.0, self.range]);
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let (mut reached, mut table) = (0.0, vec![(-self.range, 0.0)]);
        for pair in ends.windows(2) {
            let mut stack = vec![(pair[0], pair[1], 0)];
            while let Some((from, to, depth)) = stack.pop() {
                let middle = 0.5 * (from + to);
                let (whole, halves) = (self.area(from, to), self.area(from, middle) + self.area(middle, to));
                if depth < MOST_SPLITS && (whole - halves).abs() > AGREEMENT * (1.0 + whole.abs()) {
                    stack.extend([(middle, to, depth + 1), (from, middle, depth + 1)]);
                } else {
                    reached += whole;
                    table.push((to, reached));
                }
            }
        }
        let at_zero = table.iter().find(|(x, _)| *x == 0.0).map_or(0.0, |(_, value)| *value);
        table.iter_mut().for_each(|(_, value)| *value -= at_zero);
        table
    }

    fn area(&self, from: f64, to: f64) -> f64 {
        integral(from, to, |x| self.function.value(x))
    }

    fn inner_value(&self, x: f64) -> f64 {
        if self.meaning == Meaning::Potential {
            return self.function.value(x);
        }
        // From the nearer zero side, so that Phi is exactly 0 at 0.
        let index = self.integrals.partition_point(|(from, _)| *from < x).clamp(1, self.integrals.len() - 1);
        let (from, value) = self.integrals[if x > 0.0 { index - 1 } else { index }];
        value + self.area(from, x)
    }
}

/// All slopes between two places, within the range; unbounded if that cannot be said.
fn enclosed(function: &Expression, meaning: Meaning, low: f64, high: f64) -> Interval {
    function.enclosure::<2>(low, high).0[usize::from(meaning == Meaning::Potential)]
}

impl Trench for Written {
    fn value(&self, x: f64) -> f64 {
        let inner = x.clamp(-self.range, self.range);
        let beyond = x - inner;
        let rest = if beyond == 0.0 { 0.0 } else { beyond * self.one_sided(inner, beyond > 0.0) };
        self.inner_value(inner) + rest
    }

    fn slopes(&self, x: f64) -> Slopes {
        if x.abs() >= self.range {
            return Slopes::smooth(self.one_sided(x.clamp(-self.range, self.range), x > 0.0));
        }
        let index = self.kinks.partition_point(|kink| kink.high < x);
        match self.kinks.get(index) {
            Some(kink) if kink.low <= x => self.across(kink),
            _ => Slopes::smooth(self.one_sided(x, false)),
        }
    }

    /// Places within the stretches where kinks are known to be, so that [`Self::slopes`] tells both sides of each; round numbers where
    /// one lies within.
    fn kinks(&self) -> Vec<f64> {
        let within = |kink: &Rough| Some(kink.x()).filter(|x| (kink.low..=kink.high).contains(x));
        self.kinks.iter().map(|kink| within(kink).unwrap_or(0.5 * (kink.low + kink.high))).collect()
    }

    fn slope_bounds(&self, low: f64, high: f64) -> Option<Interval> {
        let within = |x: f64| x.clamp(-self.range, self.range);
        Some(enclosed(&self.function, self.meaning, within(low), within(high)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::*;
    use super::*;

    fn written(text: &str, meaning: Meaning) -> Result<Written, WrittenError> {
        Written::new(Expression::parse(text).unwrap(), meaning, 20.0)
    }

    fn same(text: &str, meaning: Meaning, built_in: &impl Trench) {
        let written = written(text, meaning).unwrap();
        for index in -240..=240 {
            let x = 0.1 * f64::from(index);
            let (found, expected) = (written.value(x), built_in.value(x));
            let inside = x.abs() <= 20.0;
            assert!(!inside || (found - expected).abs() < 1e-10 * (1.0 + expected), "{text} {x}: {found} {expected}");
            let (found, expected) = (written.slopes(x), built_in.slopes(x));
            let differs = |a: f64, b: f64| (a - b).abs() > 1e-8 * (1.0 + b.abs());
            assert!(!inside || !differs(found.left, expected.left), "{text} {x}: {found:?} {expected:?}");
            assert!(!inside || !differs(found.right, expected.right), "{text} {x}: {found:?} {expected:?}");
            assert!(written.slopes(x).left.is_finite());
        }
    }

    #[test]
    fn formulas_are_the_built_in_trenches() {
        use Meaning::{Potential, Slope};
        same("2*abs(x)", Potential, &Conic { alpha: 2.0 });
        same("2*sign(x)", Slope, &Conic { alpha: 2.0 });
        same("1.5*x^2", Potential, &Quadratic { alpha: 3.0 });
        same("10*(sqrt(x^2 + 1) - 1)", Potential, &Hyperbolic { alpha: 10.0, a: 1.0 });
        same("10*x/sqrt(x^2 + 1)", Slope, &Hyperbolic { alpha: 10.0, a: 1.0 });
        same("7.07*clamp(x, -1, 1)", Slope, &Saturated { stiffness: 7.07, edge: 1.0 });
        let first = SlopeTable::new(vec![(0.0, 0.0), (1.0, 4.0), (1.0, 1.0)]).unwrap();
        same("min(2*x^2, abs(x) + 1)", Potential, &first);
    }

    #[test]
    fn gradients_at_kinks_are_intervals() {
        let valley = written("abs(x) + abs(x - 1) + abs(x + 1) - 2", Meaning::Potential).unwrap();
        assert_eq!(valley.kinks(), [-1.0, 0.0, 1.0]);
        assert_eq!(valley.gradient(0.0), Interval { low: -1.0, high: 1.0 });
        assert_eq!(valley.gradient(1.0), Interval { low: 1.0, high: 3.0 });
        assert_eq!(valley.slope(0.0), 0.0);
    }

    #[test]
    fn formulas_that_are_no_trenches() {
        let check = |text: &str, meaning, expected: &str| {
            let error = written(text, meaning).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        };
        check("1/x", Meaning::Slope, "`1/x` is not finite at x = 0 (the division at column 2)");
        check("sqrt(abs(x))", Meaning::Potential, "is infinitely steep at x = 0 (sqrt at column 1)");
        check("sqrt(4 - x)", Meaning::Slope, "is not finite at x = 4 (sqrt at column 1)");
        check("sign(x)", Meaning::Potential, "jumps or is infinitely steep at x = 0");
        check("abs(sin(50*x))", Meaning::Potential, "more than 64 kinks");
        assert!(written("sqrt(abs(x))*sign(x)", Meaning::Slope).is_ok());
        let endless = Written::new(Expression::parse("x").unwrap(), Meaning::Slope, f64::INFINITY);
        assert_eq!(endless, Err(WrittenError::Range(f64::INFINITY)));
    }
}
