//! What the filter must know of a robot and of its control loop.
use thiserror::Error;

/// Parameters of the safety filter. All lengths from the axle's centre, about which the robot turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SafetyParameters {
    /// Radius of the disc that holds the robot at any heading, m.
    pub radius: f64,
    /// Half the distance between the wheels, m: a turning robot's outer wheel needs longer to stop.
    pub half_axle: f64,
    /// Time from a pose's exposure to the moment a command made from it acts on the wheels, s.
    pub delay: f64,
    /// Time for which a command acts, s: the longest interval between two ticks.
    pub period: f64,
    /// Deceleration that the wheels can always hold, m/s^2.
    pub braking: f64,
    /// Space kept between bodies besides the rule, m: errors of poses and of the plant's model.
    pub margin: f64,
    /// Least speed on a way round a blockage, m/s.
    pub detour_speed: f64,
}

/// A parameter that the filter cannot work with.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("safety parameter `{name}` is {value}, but must be {expected}")]
pub struct SafetyParameterError {
    /// Field of [`SafetyParameters`].
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// What would be right.
    pub expected: &'static str,
}

impl SafetyParameters {
    /// T of the rule: the age of the pose at the end of a command's effect, s.
    pub fn loop_delay(&self) -> f64 {
        self.delay + self.period
    }

    pub(super) fn check(&self) -> Result<(), SafetyParameterError> {
        let positive = [
            ("radius", self.radius),
            ("half_axle", self.half_axle),
            ("period", self.period),
            ("braking", self.braking),
            ("detour_speed", self.detour_speed),
        ];
        let not_negative = [("delay", self.delay), ("margin", self.margin)];
        for (name, value) in positive {
            if !(value.is_finite() && value > 0.0) {
                return Err(SafetyParameterError { name, value, expected: "finite and greater than zero" });
            }
        }
        for (name, value) in not_negative {
            if !(value.is_finite() && value >= 0.0) {
                return Err(SafetyParameterError { name, value, expected: "finite and zero or more" });
            }
        }
        Ok(())
    }
}
