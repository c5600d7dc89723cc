//! Definition 5.2.1, with what it lacks: x phi(x) > 0, and Lipschitz locally instead of globally (ERRATA).
use super::Trench;

/// A trench that passed on the range that was looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Admissible {
    /// The largest |phi| seen, m/s^2: the Lipschitz constant on the range, and the most a robot is accelerated.
    pub lipschitz_constant: f64,
}

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

/// Checks `trench` on [-range, range] (m): at its kinks, and at 2000 points on either side, dense near 0. A counter-example
/// between two of those points is missed, one found is real.
///
/// # Errors
/// The first condition that fails, nearest to 0 first.
pub fn check_admissibility(trench: &impl Trench, range: f64) -> Result<Admissible, Inadmissible> {
    let value = trench.value(0.0);
    if value != 0.0 {
        return Err(Inadmissible::NotZeroAtZero { value });
    }
    let rest = trench.gradient(0.0);
    if !rest.contains(0.0) {
        return Err(Inadmissible::NoRestAtZero { low: rest.low, high: rest.high });
    }
    let mut points: Vec<f64> = trench.kinks().into_iter().filter(|x| x.abs() <= range).collect();
    for index in 1..=2000 {
        let share = f64::from(index) / 2000.0;
        points.extend([range * share * share, -range * share * share]);
    }
    points.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let mut lipschitz_constant = 0.0_f64;
    for x in points {
        lipschitz_constant = lipschitz_constant.max(check_at(trench, x)?);
    }
    Ok(Admissible { lipschitz_constant })
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

    /// 2|x| + 3(1 - cos x) satisfies the printed definition and traps a robot at 2 pi - asin(2/3).
    struct Corrugated;
    impl Trench for Corrugated {
        fn value(&self, x: f64) -> f64 {
            2.0 * x.abs() + 3.0 * (1.0 - libm::cos(x))
        }
        fn slopes(&self, x: f64) -> Slopes {
            let (cone, wave) = (Conic { alpha: 2.0 }.slopes(x), 3.0 * libm::sin(x));
            Slopes { left: cone.left + wave, right: cone.right + wave }
        }
        fn kinks(&self) -> Vec<f64> {
            vec![0.0]
        }
    }

    #[test]
    fn what_is_refused() {
        let edge = core::f64::consts::PI + libm::asin(2.0 / 3.0);
        let Err(Inadmissible::Traps { x, .. }) = check_admissibility(&Corrugated, 10.0) else { panic!() };
        assert!(x.abs() >= edge && x.abs() < edge + 0.02, "{x}");
        // F_1 of Example 5.2.3: Lipschitz constant 4, but not regular at +-1.
        let first = SlopeTable::new(vec![(0.0, 0.0), (1.0, 4.0), (1.0, 1.0)]).unwrap();
        let found = check_admissibility(&first, 10.0);
        assert!(matches!(found, Err(Inadmissible::NotRegular { x, .. }) if x.abs() == 1.0), "{found:?}");
        let inverted = SlopeTable::new(vec![(0.0, -1.0)]).unwrap();
        assert!(matches!(check_admissibility(&inverted, 1.0), Err(Inadmissible::NotRegular { .. })));
        assert!(matches!(
            check_admissibility(&Quadratic { alpha: f64::NAN }, 1.0),
            Err(Inadmissible::NotZeroAtZero { .. })
        ));
    }
}
