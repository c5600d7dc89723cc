//! The Lyapunov function of chapters 3 and 4, for the stability monitor.
use crate::kinematics::{Polar, Twist};

/// V = (r^2 + phi^2)/2 of (3.12) and A.1 (1), and its derivative along a motion.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lyapunov {
    /// V, in m^2 and rad^2.
    pub value: f64,
    /// dV/dt.
    pub rate: f64,
}

impl Lyapunov {
    /// V about a resting goal point, and dV/dt under `twist` by (3.8): whatever twist is really sent, so that limits
    /// and filters behind a law show in the monitor.
    pub fn of(polar: Polar, twist: Twist) -> Self {
        let rates = polar.rates(twist);
        Self {
            value: 0.5 * (polar.distance * polar.distance + polar.misalignment * polar.misalignment),
            rate: polar.distance * rates.distance + polar.misalignment * rates.misalignment,
        }
    }
}
