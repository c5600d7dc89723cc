//! Curvature of the paths under (3.9) and (3.10), 4.2.3 as corrected.
use super::closed_form::{ClosedForm, TwoGainLaw};

impl ClosedForm {
    /// K(t) = |omega|/|v|, 1/m; infinite where v passes 0, under (3.10) at |phi| = pi/2.
    pub fn curvature(&self, time: f64) -> f64 {
        let (phi, lambda) = (self.misalignment(time), self.gain_ratio());
        let (sin, cos) = libm::sincos(phi);
        match self.law {
            TwoGainLaw::Direct => (phi / lambda + sin).abs() / self.distance(time),
            TwoGainLaw::Nominal => (phi / lambda + sin * cos).abs() / (self.distance(time) * cos.abs()),
        }
    }

    /// The curvature at the goal point. The critical gain ratio lambda = 1 separates paths that end straight from paths
    /// that wind up; there it is 2 |phi0|/r0 e^(-Cin phi0) under (3.9) and 2 |phi0|/r0 e^(-Cin(2 phi0)/2) under (3.10).
    pub fn final_curvature(&self) -> f64 {
        let (phi, lambda) = (self.start.misalignment, self.gain_ratio());
        if phi == 0.0 || lambda < 1.0 {
            0.0
        } else if lambda > 1.0 {
            f64::INFINITY
        } else {
            2.0 * phi.abs() / self.start.distance * libm::exp(-self.detour(0.0))
        }
    }

    /// S1 or S2 at A = phi: has the sign of dK/dt.
    ///
    /// For (3.10) and |phi| > pi/2 only while lambda < [`LAMBDA_STAR`](super::LAMBDA_STAR), beyond which omega changes sign.
    pub fn curvature_trend(&self, misalignment: f64) -> f64 {
        // Both are even in A.
        let (a, lambda) = (misalignment.abs(), self.gain_ratio());
        let (sin, cos) = libm::sincos(a);
        match self.law {
            TwoGainLaw::Direct => lambda * lambda * sin * cos - a,
            TwoGainLaw::Nominal => {
                let inner = lambda * lambda * sin * cos * cos * cos * cos - a * cos - a * a * sin;
                if cos >= 0.0 { inner } else { -inner }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::Polar;
    use crate::stability::{LAMBDA_STAR, entire_cosine_integral};
    use proptest::prelude::*;

    fn motion(law: TwoGainLaw, lambda: f64, phi0: f64) -> ClosedForm {
        ClosedForm { law, k1: lambda, k2: 1.0, start: Polar { distance: 1.3, misalignment: phi0 } }
    }

    /// At lambda = 1 the curvature tends to the corrected limits, which differ (the thesis has 2 |phi0|/r0 for both).
    #[test]
    fn critical_gain_ratio() {
        for phi0 in [-2.5, -0.3, 1.0, 3.0] {
            for (law, cin) in [
                (TwoGainLaw::Direct, entire_cosine_integral(phi0)),
                (TwoGainLaw::Nominal, 0.5 * entire_cosine_integral(2.0 * phi0)),
            ] {
                let motion = motion(law, 1.0, phi0);
                let limit = 2.0 * phi0.abs() / 1.3 * libm::exp(-cin);
                assert!((motion.final_curvature() - limit).abs() < 1e-14);
                assert!((motion.curvature(18.0) - limit).abs() < 1e-12 * limit.max(1.0));
            }
        }
        assert_eq!(motion(TwoGainLaw::Direct, 0.9, 1.0).final_curvature(), 0.0);
        assert_eq!(motion(TwoGainLaw::Direct, 1.1, 1.0).final_curvature(), f64::INFINITY);
    }

    /// K2(0) >= K1(0) holds for |phi0| < pi/2 only (the thesis: always).
    #[test]
    fn order_of_initial_curvatures_turns_around() {
        let at = |law, phi0| motion(law, 0.5, phi0).curvature(0.0);
        assert!(at(TwoGainLaw::Nominal, 1.2) > at(TwoGainLaw::Direct, 1.2));
        assert!(at(TwoGainLaw::Nominal, 3.1) < at(TwoGainLaw::Direct, 3.1));
    }

    proptest! {
        /// The trend has the sign of the derivative of the curvature; for lambda <= 1 and |phi| < pi/2 it is negative.
        #[test]
        fn trend_is_the_sign_of_the_derivative(lambda in 0.1..4.6_f64, phi0 in -3.1..3.1_f64, nominal: bool) {
            prop_assume!(lambda < LAMBDA_STAR - 0.01 && phi0.abs() > 0.05 && libm::cos(phi0).abs() > 0.05);
            let motion = motion(if nominal { TwoGainLaw::Nominal } else { TwoGainLaw::Direct }, lambda, phi0);
            let step = 1e-6;
            let slope = (motion.curvature(step) - motion.curvature(-step)) / (2.0 * step);
            let trend = motion.curvature_trend(phi0);
            prop_assume!(slope.abs() > 1e-6);
            prop_assert!(slope * trend > 0.0, "{slope} {trend}");
            if lambda <= 1.0 && phi0.abs() < core::f64::consts::FRAC_PI_2 {
                prop_assert!(trend < 0.0);
            }
        }
    }
}
