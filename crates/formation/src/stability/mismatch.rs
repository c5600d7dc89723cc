//! Where phi comes to rest when the gains mismatch, 4.4.3.
use crate::laws::Robust;
use core::f64::consts::{PI, TAU};

/// phi(inf) of (4.8) from `start` in (-pi, pi]: 0 inside the stable zone, elsewhere perhaps not. K2 must be positive.
pub fn final_misalignment(gains: Robust, start: f64) -> f64 {
    let rate = |phi: f64| gains.misalignment_rate(phi);
    let (begin, sign) = (start.abs(), 1.0_f64.copysign(start));
    let slope = rate(begin);
    if slope == 0.0 {
        return start;
    }
    // Between the points where the rate is stationary, 2 phi = +-acos(-K2/(2 K4)) + 2 pi n, it has one zero at most, and
    // phi stops at the first one on its way. At 0 the rate vanishes; at pi it is negative, so phi never gets there.
    let bound = -gains.k2 / (2.0 * gains.k4());
    let turn = if bound.abs() <= 1.0 { libm::acos(bound) } else { 0.0 };
    let mut borders = [0.5 * turn, 0.5 * (TAU - turn)].map(|border| border.min(PI));
    if slope < 0.0 {
        borders.reverse();
    }
    let end = if slope < 0.0 { 0.0 } else { PI };
    let mut from = begin;
    for to in borders.into_iter().chain([end]) {
        if (to - from) * slope <= 0.0 {
            continue;
        }
        if rate(to) * slope <= 0.0 && to != 0.0 {
            return sign * bisect(rate, from, to);
        }
        from = to;
    }
    0.0
}

fn bisect(function: impl Fn(f64) -> f64, mut from: f64, mut to: f64) -> f64 {
    let sign = function(from);
    loop {
        let middle = 0.5 * (from + to);
        if middle == from || middle == to {
            return middle;
        }
        if function(middle) * sign > 0.0 { from = middle } else { to = middle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stability::{StableZone, rk4};
    use nalgebra::Vector1;
    use proptest::prelude::*;

    fn check(k3: f64, start: f64, expected: f64) {
        let got = final_misalignment(Robust { k1: 20.0, k2: 1.0, k3 }, start);
        assert!((got - expected).abs() < 1e-9, "{got}");
        let mirrored = final_misalignment(Robust { k1: 20.0, k2: 1.0, k3 }, -start);
        assert!((mirrored + expected).abs() < 1e-9, "{mirrored}");
    }

    #[test]
    fn the_two_cases_of_the_thesis() {
        check(18.8, 1.0, 0.513_369_145_7);
        check(18.8, 0.1, 0.513_369_145_7);
        check(24.8, PI, 2.393_369_533_0);
        check(24.8, 1.0, 0.0);
        check(20.0, 3.0, 0.0);
    }

    proptest! {
        #[test]
        fn agrees_with_integration(k2 in 0.2..2.0_f64, k3 in -6.0..12.0_f64, start in -3.1..3.1_f64) {
            let gains = Robust { k1: 1.0, k2, k3 };
            let expected = final_misalignment(gains, start);
            let mut phi = Vector1::new(start);
            for _ in 0..8000 {
                phi = rk4(0.0, phi, 0.01, |_, phi| Vector1::new(gains.misalignment_rate(phi.x)));
            }
            // At saddle-nodes the approach is slower than any exponential.
            prop_assume!(gains.misalignment_rate(phi.x).abs() < 1e-9);
            prop_assert!((phi.x - expected).abs() < 1e-4, "{} {expected}", phi.x);
            if StableZone::check(gains).is_ok() {
                prop_assert_eq!(expected, 0.0);
            }
        }
    }
}
