//! Which gains of (3.13) stabilise phi: the stable zone of 4.3.1, as corrected.
//!
//! (4.8) reads phi'/phi = -(K2 + 2 K4 sinc(2 phi)). The smallest sinc, at the first positive root x1 of tan x = x, is
//! -1/sqrt(1 + x1^2) = -1/(2 c1); the largest is 1. So phi = 0 attracts every phi exponentially exactly when
//! K2 > 0 and -K2/2 < K4 < c1 K2. For K2 < 0 phi = 0 repels (the wedge of Fig. 4.7 does not exist).
use super::Violation;
use crate::laws::Robust;

/// c1 = sqrt(1 + x1^2)/2, x1 the first positive root of tan x = x: the upper bound of K4/K2.
pub const C1: f64 = 2.301_669_424_375_85;
/// c2: the lower bound of K4/K2.
pub const C2: f64 = -0.5;
/// lambda* of 4.2.3: up to it the robot never turns against its misalignment under (3.10); twice c1.
pub const LAMBDA_STAR: f64 = 4.603_338_848_751_7;

/// How far inside an open bound the proposed gain lies, as a share of the zone's width.
const MARGIN: f64 = 0.01;

/// The wedge of Fig. 4.8.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StableZone;

impl StableZone {
    /// Whether the gains lie in the zone.
    ///
    /// # Errors
    /// The first bound that they violate.
    pub fn check(gains: Robust) -> Result<(), Violation> {
        let Robust { k1, k2, k3 } = gains;
        for (gain, value) in [("K1", k1), ("K2", k2), ("K3", k3)] {
            if !value.is_finite() {
                return Err(Violation::NotFinite { gain, value });
            }
        }
        if k1 <= 0.0 {
            return Err(Violation::SpeedGain { k1, nearest: nearest_speed_gain(k2, k3) });
        }
        if k2 <= 0.0 {
            return Err(Violation::TurnGain { k2, nearest: nearest_turn_gain(gains) });
        }
        let (low, high) = Self::turn_bounds(k1, k2);
        let margin = MARGIN * (high - low);
        if k3 <= low {
            return Err(Violation::TooLow { k3, limit: low, nearest: low + margin });
        }
        if k3 >= high {
            return Err(Violation::TooHigh { k3, limit: high, nearest: high - margin });
        }
        Ok(())
    }

    /// The open interval of K3 for given K1 and K2 > 0: (K1 + 2 c2 K2, K1 + 2 c1 K2).
    pub fn turn_bounds(k1: f64, k2: f64) -> (f64, f64) {
        (k1 + 2.0 * C2 * k2, k1 + 2.0 * C1 * k2)
    }

    /// Guideline (2) of 4.3.2: K3 in the middle of the zone.
    pub fn centred(k1: f64, k2: f64) -> Robust {
        Robust { k1, k2, k3: k1 + (C1 + C2) * k2 }
    }

    /// Guideline (3): K3 in the middle of the upper part, which does not slow phi while |phi| <= pi/2.
    pub fn centred_above(k1: f64, k2: f64) -> Robust {
        Robust { k1, k2, k3: k1 + C1 * k2 }
    }

    /// A rate c with |phi(t)| <= |phi(0)| e^(-c t) from every phi(0), 1/s; positive exactly inside the zone.
    pub fn guaranteed_rate(gains: Robust) -> f64 {
        let k4 = gains.k4();
        if k4 >= 0.0 { gains.k2 - k4 / C1 } else { gains.k2 + 2.0 * k4 }
    }
}

/// K1 alone moves the wedge along K3 = K1; where that allows no positive K1, a K1 that is positive at least.
fn nearest_speed_gain(k2: f64, k3: f64) -> f64 {
    let small = MARGIN * k2.abs().max(MARGIN);
    if k2 > 0.0 { small.max(k3 - 2.0 * C1 * k2 + small) } else { small }
}

fn nearest_turn_gain(gains: Robust) -> f64 {
    let k4 = gains.k4();
    let limit = (k4 / C2).max(k4 / C1);
    limit + MARGIN * limit.max(gains.k1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// tan x = x as x = pi + atan(x), a contraction.
    #[test]
    fn constants() {
        let mut root = 4.5;
        for _ in 0..60 {
            root = core::f64::consts::PI + libm::atan(root);
        }
        let lambda = (1.0 + root * root).sqrt();
        assert!((LAMBDA_STAR - lambda).abs() < 1e-12 && (C1 - 0.5 * lambda).abs() < 1e-12);
    }

    #[test]
    fn guidelines_of_4_4_4() {
        assert!((StableZone::centred(20.0, 1.0).k3 - 21.80).abs() < 5e-3);
        assert!((StableZone::centred_above(20.0, 1.0).k3 - 22.30).abs() < 5e-3);
    }

    fn check(k1: f64, k2: f64, k3: f64, wrong: Option<&str>) {
        let result = StableZone::check(Robust { k1, k2, k3 });
        assert_eq!(result.err().map(|violation| violation.gain()), wrong, "{k1} {k2} {k3}");
    }

    #[test]
    fn verdicts() {
        check(0.1, 1.0, 0.12, None);
        check(20.0, 1.0, 18.8, Some("K3"));
        check(20.0, 1.0, 24.8, Some("K3"));
        check(20.0, 1.0, 19.0, Some("K3"));
        check(20.0, -1.0, 22.0, Some("K2"));
        check(0.0, 1.0, 0.0, Some("K1"));
        check(1.0, f64::NAN, 1.0, Some("K2"));
        let text = StableZone::check(Robust { k1: 20.0, k2: 1.0, k3: 18.8 }).unwrap_err().to_string();
        assert!(text.contains("K1 + 2 c2 K2 = 19") && text.contains("nearest admissible K3 is 19.05"), "{text}");
    }

    proptest! {
        /// The zone is where the rate is positive, and what a violation proposes is in the zone.
        #[test]
        fn proposals_are_admissible(k1 in 0.01..30.0_f64, k2 in -5.0..5.0_f64, k3 in -40.0..80.0_f64) {
            let gains = Robust { k1, k2, k3 };
            match StableZone::check(gains) {
                Ok(()) => prop_assert!(StableZone::guaranteed_rate(gains) > 0.0),
                Err(violation) => {
                    let nearest = violation.nearest().unwrap();
                    let mended = if violation.gain() == "K2" { Robust { k2: nearest, ..gains } } else { Robust { k3: nearest, ..gains } };
                    prop_assert_eq!(StableZone::check(mended), Ok(()));
                    prop_assert!(k2 <= 0.0 || StableZone::guaranteed_rate(gains) <= 1e-12);
                }
            }
        }

        /// phi' phi <= -c phi^2 for every phi.
        #[test]
        fn rate_is_a_bound(k2 in 0.1..3.0_f64, share in 0.01..0.99_f64, phi in -3.1..3.1_f64) {
            let (low, high) = StableZone::turn_bounds(1.0, k2);
            let gains = Robust { k1: 1.0, k2, k3: low + share * (high - low) };
            let rate = StableZone::guaranteed_rate(gains);
            prop_assert!(phi * gains.misalignment_rate(phi) <= -rate * phi * phi + 1e-12);
        }
    }
}
