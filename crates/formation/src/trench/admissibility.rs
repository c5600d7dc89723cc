//! Definition 5.2.1, with what it lacks: x phi(x) > 0, and Lipschitz locally instead of globally (ERRATA).
use super::steepest::steepest;
use super::{Interval, Trench};

/// A trench that passed on the range that was looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Admissible {
    /// The Lipschitz constant on the range, and the most a robot is accelerated, m/s^2. Where [`Self::proved_from`] says something, a bound
    /// that no |phi| exceeds, and no more than a share of 1e-4 above the largest (farther for formulas that 200,000 intervals do not
    /// settle); else the largest that was seen: there may be larger ones in between.
    pub lipschitz_constant: f64,
    /// From this |x| (m) to the end of the range x phi(x) > 0 is proved, not only seen; none if the trench gives no bounds, when nothing
    /// is proved.
    pub proved_from: Option<f64>,
}

/// Proofs begin at this share of the range.
pub(super) const NEAREST: f64 = 1e-9;
/// More intervals than these are not looked at: where a slope is hardly above 0 for long, and its formula takes large terms from each other, it
/// would be millions.
const MOST: usize = 200_000;

/// Which condition fails, and where.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Inadmissible {
    /// Condition (1), Lipschitz.
    #[error("the potential is not Lipschitz at x = {x}: its value or slope is not finite (Definition 5.2.1 (1))")]
    NotLipschitz {
        /// Metres.
        x: f64,
    },
    /// Condition (1), regular: the kink points upward.
    #[error(
        "the potential is not regular at x = {x}: its slope falls from {left} to {right}, a kink that points upward \
         (Definition 5.2.1 (1)); smooth it or let the slope rise there"
    )]
    NotRegular {
        /// Metres.
        x: f64,
        /// Slope before.
        left: f64,
        /// Slope behind.
        right: f64,
    },
    /// Condition (2) at 0.
    #[error("the potential is {value} at x = 0; it must be 0 there (Definition 5.2.1 (2))")]
    NotZeroAtZero {
        /// Phi(0).
        value: f64,
    },
    /// Condition (2) elsewhere.
    #[error("the potential is {value} at x = {x}; it must be positive (Definition 5.2.1 (2))")]
    NotPositive {
        /// Metres.
        x: f64,
        /// Phi(x).
        value: f64,
    },
    /// Condition (3).
    #[error("the gradient at x = 0 is [{low}, {high}]; it must contain 0 (Definition 5.2.1 (3))")]
    NoRestAtZero {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// x phi(x) > 0 fails.
    #[error(
        "the potential does not pull towards 0 at x = {x} (slope {slope}): a robot beyond would be trapped; \
         x phi(x) must be positive (Definition 5.2.1, strengthened)"
    )]
    Traps {
        /// Metres.
        x: f64,
        /// phi(x).
        slope: f64,
    },
}

/// Checks `trench` on [-range, range] (m): at its kinks; x phi(x) > 0 and the Lipschitz constant by bounds on whole intervals, if the trench
/// gives them; and at 2000 points on either side, dense near 0. What is found is real; without bounds, what lies between two points may be
/// missed.
///
/// # Errors
/// The first condition that fails: at 0, at the kinks, beyond; each nearest to 0 first.
pub fn check_admissibility(trench: &impl Trench, range: f64) -> Result<Admissible, Inadmissible> {
    let value = trench.value(0.0);
    // A sum of terms that cancel at 0 may leave rounding behind.
    if value.is_nan() || value.abs() > 1e-12 * trench.value(range).abs().min(1.0) {
        return Err(Inadmissible::NotZeroAtZero { value });
    }
    let rest = trench.gradient(0.0);
    if !rest.contains(0.0) && rest.smallest().abs() > 1e-12 * trench.gradient(range).magnitude() {
        return Err(Inadmissible::NoRestAtZero { low: rest.low, high: rest.high });
    }
    let mut largest_seen = 0.0_f64;
    let mut kinks: Vec<f64> = trench.kinks().into_iter().filter(|x| x.abs() <= range).collect();
    kinks.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    for x in kinks {
        largest_seen = largest_seen.max(check_at(trench, x)?);
    }
    let proved_from = prove(trench, range)?;
    for index in 1..=2000 {
        let share = f64::from(index) / 2000.0;
        for x in [range * share * share, -range * share * share] {
            largest_seen = largest_seen.max(check_at(trench, x)?);
        }
    }
    let lipschitz_constant = steepest(trench, range, largest_seen).unwrap_or(largest_seen);
    Ok(Admissible { lipschitz_constant, proved_from })
}

/// Proves x phi(x) > 0 by bounds on intervals that are halved, from [`NEAREST`] of the range on: from where it is proved, or the
/// place nearest to 0 where it fails (to 1e-8 m).
fn prove(trench: &impl Trench, range: f64) -> Result<Option<f64>, Inadmissible> {
    let away = |side: f64, slopes: Interval| if side > 0.0 { slopes.low } else { -slopes.high };
    let proved = first_unproved(|low, high| trench.slope_bounds(low, high), away, range);
    proved.map_err(|x| Inadmissible::Traps { x, slope: trench.slope(x) })
}

/// Proves that `least` of what `bounds` says is positive on all intervals on the sides -1 and 1 of 0, from [`NEAREST`] of the range on: from
/// where that is proved, nothing without bounds or where 200,000 intervals do not suffice, or the place nearest to 0 where it fails (to 1e-8 m).
pub(super) fn first_unproved(
    bounds: impl Fn(f64, f64) -> Option<Interval>,
    least: impl Fn(f64, Interval) -> f64,
    range: f64,
) -> Result<Option<f64>, f64> {
    let mut cells = vec![];
    let mut outer = range;
    while outer > NEAREST * range {
        cells.extend([(-1.0, 0.5 * outer, outer), (1.0, 0.5 * outer, outer)]);
        outer *= 0.5;
    }
    let mut looked = 0;
    while let Some((side, from, to)) = cells.pop() {
        looked += 1;
        if looked > MOST {
            return Ok(None);
        }
        let Some(found) = bounds((side * from).min(side * to), (side * from).max(side * to)) else {
            return Ok(None);
        };
        if least(side, found) > 0.0 {
            continue;
        }
        if to - from < 1e-10 * to {
            return Err(side * libm::round(to * 1e8) * 1e-8);
        }
        let middle = 0.5 * (from + to);
        cells.extend([(side, middle, to), (side, from, middle)]);
    }
    Ok(Some(outer))
}

/// The largest |phi| at `x`, or what is wrong there.
fn check_at(trench: &impl Trench, x: f64) -> Result<f64, Inadmissible> {
    let (value, slopes) = (trench.value(x), trench.slopes(x));
    if !(value.is_finite() && slopes.left.is_finite() && slopes.right.is_finite()) {
        return Err(Inadmissible::NotLipschitz { x });
    }
    // Slopes that differ by rounding are no kink.
    if slopes.left - slopes.right > 1e-9 * (slopes.left.abs() + slopes.right.abs()) {
        return Err(Inadmissible::NotRegular { x, left: slopes.left, right: slopes.right });
    }
    if x != 0.0 {
        if value <= 0.0 {
            return Err(Inadmissible::NotPositive { x, value });
        }
        for slope in [slopes.left, slopes.right] {
            if x * slope <= 0.0 {
                return Err(Inadmissible::Traps { x, slope });
            }
        }
    }
    Ok(slopes.left.abs().max(slopes.right.abs()))
}

#[cfg(test)]
mod tests {
    use super::super::*;
    use super::*;

    fn admissible(trench: &impl Trench, constant: f64) {
        let found = check_admissibility(trench, 10.0).unwrap().lipschitz_constant;
        assert!((found - constant).abs() < 1e-6, "{found}");
    }

    #[test]
    fn examples_of_the_thesis() {
        admissible(&Conic { alpha: 2.0 }, 2.0);
        admissible(&Quadratic { alpha: 3.0 }, 30.0);
        admissible(&Hyperbolic { alpha: 10.0, a: 1.0 }, 100.0 / 101.0_f64.sqrt());
        admissible(&Saturated { stiffness: 7.07, edge: 1.0 }, 7.07);
        admissible(&SquareRoot, 2.0);
        admissible(&CriticallyDamped(ConstantDamping { coefficient: 2.0 }), 10.0);
        admissible(&CriticallyDamped(HyperbolicDamping { alpha: 2.0, a: 0.5 }), 9.500_623_831);
    }

    fn written(text: &str) -> Written {
        Written::new(trench_expression::Expression::parse(text).unwrap(), Meaning::Potential, 10.0).unwrap()
    }

    #[test]
    fn formulas_are_proved() {
        for text in ["2*abs(x)", "x^4 + abs(x)", "10*(sqrt(x^2+1) - 1)", "max(x^2, abs(x)/2)", "1 - exp(-x^2/200)"] {
            let found = check_admissibility(&written(text), 10.0);
            assert!(found.is_ok_and(|found| found.proved_from.is_some_and(|from| from < 1e-7)), "{text} {found:?}");
        }
        let check = |text: &str, expected: &str| {
            let found = check_admissibility(&written(text), 10.0).map_err(|wrong| wrong.to_string());
            assert!(found.clone().is_err_and(|text| text.contains(expected)), "{text}: {found:?}");
        };
        check("x^2 + 1", "the potential is 1 at x = 0");
        check("x^2 + x", "the gradient at x = 0 is [1, 1]; it must contain 0");
        check("-x^2", "does not pull towards 0");
        check("x^2 - x^4/50", "does not pull towards 0 at x = 5 ");
        check("-abs(x)", "not regular at x = 0");
        // A well of a hundredth of a millimetre, which no sampling sees.
        check("abs(x) - 0.001*tanh(100000*(x - 1.2345678))*1.1 - 0.001*tanh(123456.78)*1.1", "at x = 1.2345");
    }

    /// A kink upward at an irrational place, and a slope that has a corner there and falls steeply behind: regular, both.
    #[test]
    fn irrational_places_may_be_regular() {
        assert!(check_admissibility(&written("max(x^2, sqrt(2)*abs(x))"), 10.0).is_ok());
        let text = "sign(x)*min(1e7*abs(x), max(2*sqrt(2) - 1e7*abs(x), 0.5))";
        let slope = trench_expression::Expression::parse(text).unwrap();
        let found = check_admissibility(&Written::new(slope, Meaning::Slope, 10.0).unwrap(), 10.0);
        assert!(found.is_ok(), "{found:?}");
    }

    /// The constant of a formula is a bound, however narrow the place of the largest slope is.
    #[test]
    fn the_lipschitz_constant_is_a_bound() {
        let text = "clamp(x,-1,1)+50*(exp(-((x-33.337)*300)^2)-exp(-((x+33.337)*300)^2))";
        let slope = trench_expression::Expression::parse(text).unwrap();
        let spike = Written::new(slope, Meaning::Slope, 100.0).unwrap();
        let found = check_admissibility(&spike, 100.0).unwrap();
        assert!((51.0..51.01).contains(&found.lipschitz_constant), "{found:?}");
    }

    /// Without bounds the constant is what was seen, and nothing is said to be proved.
    #[test]
    fn without_bounds_nothing_is_proved() {
        struct Opaque;
        impl Trench for Opaque {
            fn value(&self, x: f64) -> f64 {
                x.abs()
            }

            fn slopes(&self, x: f64) -> Slopes {
                Conic { alpha: 1.0 }.slopes(x)
            }
        }
        let found = check_admissibility(&Opaque, 10.0).unwrap();
        assert_eq!(found, Admissible { lipschitz_constant: 1.0, proved_from: None });
    }

    #[test]
    fn what_is_refused() {
        let edge = core::f64::consts::PI + libm::asin(2.0 / 3.0);
        let Err(Inadmissible::Traps { x, .. }) = check_admissibility(&written("2*abs(x) + 3*(1 - cos(x))"), 10.0)
        else {
            panic!()
        };
        assert!((x.abs() - edge).abs() < 1e-5, "{x}");
        // F_1 of Example 5.2.3: Lipschitz constant 4, but not regular at +-1.
        let first = SlopeTable::new(vec![(0.0, 0.0), (1.0, 4.0), (1.0, 1.0)]).unwrap();
        let found = check_admissibility(&first, 10.0);
        assert!(matches!(found, Err(Inadmissible::NotRegular { x, .. }) if x.abs() == 1.0), "{found:?}");
        // The same at irrational places: (1 + sqrt 9.8)/4, and (0.1 + sqrt 16.01)/2.
        for (text, kink) in
            [("min(2*x^2, abs(x) + 1.1)", 1.032_623_792_124_926), ("min(x^2, 4 + abs(x)/10)", 2.050_624_902_374_256)]
        {
            let found = check_admissibility(&written(text), 10.0);
            let refused = matches!(found, Err(Inadmissible::NotRegular { x, .. }) if (x.abs() - kink).abs() < 1e-8);
            assert!(refused, "{text}: {found:?}");
        }
        let inverted = SlopeTable::new(vec![(0.0, -1.0)]).unwrap();
        assert!(matches!(check_admissibility(&inverted, 1.0), Err(Inadmissible::NotRegular { .. })));
        assert!(matches!(
            check_admissibility(&Quadratic { alpha: f64::NAN }, 1.0),
            Err(Inadmissible::NotZeroAtZero { .. })
        ));
    }
}
