//! Motion under (3.9) and (3.10) in closed form, 4.2.
//!
//! With lambda = K1/K2, both laws give phi(t) = phi0 e^(-K2 t), and with A = phi(t)
//!
//! | | (3.9) | (3.10) |
//! |---|---|---|
//! | r(t) | r0 e^(-K1 t + lambda (Cin phi0 - Cin A)) | r0 e^(-K1 t + lambda (Cin 2 phi0 - Cin 2A)/2) |
//! | theta(t) - theta0 | A - phi0 + lambda (Si A - Si phi0) | A - phi0 + lambda (Si 2A - Si 2 phi0)/2 |
//!
//! (4.2.2 prints the headings exchanged). r as a function of phi depends on lambda alone: Propositions 4.2.1, 4.2.2.
use super::special::{entire_cosine_integral, sine_integral};
use crate::kinematics::Polar;

/// Which of the two laws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TwoGainLaw {
    /// (3.9).
    Direct,
    /// (3.10).
    Nominal,
}

/// A motion towards a resting goal point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosedForm {
    /// The law.
    pub law: TwoGainLaw,
    /// K1, 1/s.
    pub k1: f64,
    /// K2, 1/s, positive.
    pub k2: f64,
    /// r0 (positive) and phi0.
    pub start: Polar,
}

impl ClosedForm {
    /// lambda = K1/K2.
    pub fn gain_ratio(&self) -> f64 {
        self.k1 / self.k2
    }

    /// phi(t), (4.6) and (4.7), radians.
    pub fn misalignment(&self, time: f64) -> f64 {
        self.start.misalignment * libm::exp(-self.k2 * time)
    }

    /// r(t), metres.
    pub fn distance(&self, time: f64) -> f64 {
        self.start.distance * libm::exp(self.gain_ratio() * self.detour(self.misalignment(time)) - self.k1 * time)
    }

    /// r where phi has become `misalignment`, between phi0 (not 0) and 0: the path itself, without time.
    pub fn distance_at(&self, misalignment: f64) -> f64 {
        let share = misalignment / self.start.misalignment;
        self.start.distance * libm::exp(self.gain_ratio() * (libm::log(share) + self.detour(misalignment)))
    }

    /// theta(t) - theta(0), radians, counted through full turns.
    pub fn heading_change(&self, time: f64) -> f64 {
        self.heading_primitive(self.misalignment(time)) - self.heading_primitive(self.start.misalignment)
    }

    /// theta(inf) - theta(0); its magnitude is H_c. It is the net change: for (3.10) with lambda > lambda* and
    /// |phi0| > pi/2 the robot turns to and fro, and more in total.
    pub fn final_heading_change(&self) -> f64 {
        -self.heading_primitive(self.start.misalignment)
    }

    /// Cin phi0 - Cin phi, or its counterpart: how much larger log r/lambda is than on the straight path.
    pub(super) fn detour(&self, misalignment: f64) -> f64 {
        let primitive = |phi: f64| match self.law {
            TwoGainLaw::Direct => entire_cosine_integral(phi),
            TwoGainLaw::Nominal => 0.5 * entire_cosine_integral(2.0 * phi),
        };
        primitive(self.start.misalignment) - primitive(misalignment)
    }

    fn heading_primitive(&self, phi: f64) -> f64 {
        phi + self.gain_ratio()
            * match self.law {
                TwoGainLaw::Direct => sine_integral(phi),
                TwoGainLaw::Nominal => 0.5 * sine_integral(2.0 * phi),
            }
    }
}
