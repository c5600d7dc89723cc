//! The Lipschitz constant of Definition 5.2.1 (1) as a bound that is proved, not only seen.
use super::Trench;
use std::collections::VecDeque;

/// The bound lies no farther above the largest |phi| than this share of it.
const TOLERANCE: f64 = 1e-4;
/// More intervals than these are not looked at: a formula in which the same terms stand again and again needs ever more, and is left with a
/// bound that may be farther above.
const MOST: usize = 200_000;

/// A bound of |phi| on [-range, range] (m), m/s^2, of which `seen` is a value: never below, and above the largest value by a share of at
/// most 1e-4, unless 200,000 intervals do not suffice for that. Nothing if the trench gives no bounds.
///
/// An interval is halved until what the trench says of it is hardly above what has been seen somewhere; all on a level first, so that where
/// the work ends all intervals are about as fine.
pub(super) fn steepest(trench: &impl Trench, range: f64, seen: f64) -> Option<f64> {
    let (mut seen, mut bound, mut count) = (seen, seen, 0);
    let mut cells = VecDeque::from([(-range, range)]);
    while let Some((low, high)) = cells.pop_front() {
        let largest = trench.slope_bounds(low, high)?.magnitude();
        let middle = 0.5 * (low + high);
        let at_middle = trench.gradient(middle).magnitude();
        seen = seen.max(at_middle);
        count += 1;
        if largest <= seen * (1.0 + TOLERANCE) || count >= MOST || middle <= low || high <= middle {
            bound = bound.max(largest);
        } else {
            cells.extend([(low, middle), (middle, high)]);
        }
    }
    Some(bound)
}

#[cfg(test)]
mod tests {
    use super::super::*;
    use super::*;
    use trench_expression::Expression;

    fn check(trench: &impl Trench, largest: f64) {
        let bound = steepest(trench, 100.0, 0.0).unwrap();
        assert!(largest <= bound && bound <= largest * (1.0 + 1.01 * TOLERANCE), "{bound}, not {largest}");
    }

    fn slope(text: &str) -> Written {
        Written::new(Expression::parse(text).unwrap(), Meaning::Slope, 100.0).unwrap()
    }

    #[test]
    fn bounds_are_above_and_near() {
        check(&Conic { alpha: 2.0 }, 2.0);
        check(&Quadratic { alpha: 3.0 }, 300.0);
        check(&SquareRoot, 2.0);
        check(&slope("10*x/sqrt(x^2 + 1)"), 1000.0 / libm::sqrt(10_001.0));
        check(&slope("x*(2 + sin(x))*exp(-abs(x)/10)"), 10.986505018);
        // A corner of a table between two places at which it might be looked at.
        let table = SlopeTable::new(vec![(0.0, 0.0), (33.332, 1.0), (33.337, 51.0), (33.342, 1.0)]).unwrap();
        check(&table, 51.0);
        // A spike a hundredth of a metre wide.
        check(&slope("clamp(x, -1, 1) + 50*(exp(-((x - 33.337)*300)^2) - exp(-((x + 33.337)*300)^2))"), 51.0);
    }

    /// sin^2 + cos^2 is 1, but of intervals only nearly: the work ends with a bound that is still one.
    #[test]
    fn what_intervals_hardly_tell_ends_with_a_bound() {
        let bound = steepest(&slope("sin(50*x)^2*sign(x) + cos(50*x)^2*sign(x)"), 100.0, 0.0).unwrap();
        assert!((1.0..1.1).contains(&bound), "{bound}");
    }
}
