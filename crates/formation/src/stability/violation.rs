//! What is wrong with gains outside the stable zone.

/// Gains outside the stable zone: which bound they violate, and what would be right.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Violation {
    /// A gain is not a number one can drive with.
    #[error("{gain} is {value}: gains must be finite")]
    NotFinite {
        /// "K1", "K2" or "K3".
        gain: &'static str,
        /// What it is.
        value: f64,
    },
    /// r does not fall.
    #[error(
        "K1 = {k1} violates K1 > 0: by (3.18) r' = -K1 r cos^2 phi, and the robot would not approach its goal point; \
         the nearest admissible K1 is {nearest}"
    )]
    SpeedGain {
        /// The gain.
        k1: f64,
        /// What would do.
        nearest: f64,
    },
    /// phi = 0 repels.
    #[error(
        "K2 = {k2} violates K2 > 0: by (4.8) the robot would turn away from its goal point whatever K3 is (section \
         4.3.1); the nearest K2 that is admissible with this K1 and K3 is {nearest}"
    )]
    TurnGain {
        /// The gain.
        k2: f64,
        /// What would do.
        nearest: f64,
    },
    /// Below the wedge of Fig. 4.8, or on its edge, where convergence is not exponential.
    #[error(
        "K3 = {k3} violates the lower bound K3 > K1 + 2 c2 K2 = {limit} (section 4.3.1, c2 = -1/2): phi = 0 would not \
         be exponentially stable; the nearest admissible K3 is {nearest}"
    )]
    TooLow {
        /// The gain.
        k3: f64,
        /// The bound, not admissible itself.
        limit: f64,
        /// What would do.
        nearest: f64,
    },
    /// Above the wedge of Fig. 4.8, or on its edge.
    #[error(
        "K3 = {k3} violates the upper bound K3 < K1 + 2 c1 K2 = {limit} (section 4.3.1, c1 = 2.301669): a robot that \
         faces away from its goal point would settle misaligned; the nearest admissible K3 is {nearest}"
    )]
    TooHigh {
        /// The gain.
        k3: f64,
        /// The bound, not admissible itself.
        limit: f64,
        /// What would do.
        nearest: f64,
    },
}

impl Violation {
    /// The gain that is wrong: "K1", "K2" or "K3".
    pub fn gain(&self) -> &'static str {
        match self {
            Self::NotFinite { gain, .. } => gain,
            Self::SpeedGain { .. } => "K1",
            Self::TurnGain { .. } => "K2",
            Self::TooLow { .. } | Self::TooHigh { .. } => "K3",
        }
    }

    /// An admissible value of that gain close to the one given, the others unchanged (K1 at least positive).
    pub fn nearest(&self) -> Option<f64> {
        match *self {
            Self::NotFinite { .. } => None,
            Self::SpeedGain { nearest, .. }
            | Self::TurnGain { nearest, .. }
            | Self::TooLow { nearest, .. }
            | Self::TooHigh { nearest, .. } => Some(nearest),
        }
    }
}
