//! What the stability arguments ask for, and what is said where it does not hold.

use crate::law::Law;
use crate::ports::MAP;
use crate::tick::{Command, Tick};
use std::fmt;
use trench_core::Condition;
use trench_formation::stability::Input;
use trench_formation::zoning::Zone;
use trench_msgs::msg::{LeaderState, Stability};
use trench_msgs::std_msgs::Header;

/// A condition of a stability argument that does not hold.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Violation {
    /// V is beyond its bound.
    Balance { value: f64, bound: f64, term: Input },
    /// The robot does something else than it is told.
    Deviates,
    /// The operator allowed gains that are refused otherwise, for this reason.
    Gains(String),
    /// In zone 1 of the robot that it follows.
    Near { leader: String, distance: f64, least: f64 },
    /// The robot that it follows is out of reach.
    Far { leader: String, distance: f64, most: f64 },
}

impl Violation {
    /// The condition, by its number in the thesis; `law` is the equation in force.
    fn equation<'a>(&self, law: &'a str) -> &'a str {
        match self {
            Self::Balance { .. } | Self::Gains(_) => law,
            Self::Deviates => "(3.8)",
            Self::Near { .. } => "A.12 (i)",
            Self::Far { .. } => "6.2.2",
        }
    }

    /// What follows: without V or the robot's obedience nothing is proved; the others are the operator's choice, or pass.
    pub(crate) fn condition(&self) -> Condition {
        match self {
            Self::Balance { .. } | Self::Deviates => Condition::Error,
            Self::Gains(_) | Self::Near { .. } | Self::Far { .. } => Condition::Warn,
        }
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Balance { value, bound, term } => {
                let most = term.name();
                write!(
                    formatter,
                    "V = {value:.4} is beyond {bound:.4}, what it was and all that inputs (most: {most}) brought in"
                )
            }
            Self::Deviates => write!(formatter, "the robot has not followed its commands for a while"),
            Self::Gains(reason) => write!(formatter, "{reason}"),
            Self::Near { leader, distance, least } => {
                write!(formatter, "{distance:.3} m from {leader}, within zone 1 of {least} m")
            }
            Self::Far { leader, distance, most } => {
                write!(formatter, "{distance:.3} m from {leader}, beyond rho_bar = {most} m: no coordinated chain")
            }
        }
    }
}

impl Tick {
    /// What the monitor says of a tick in which a law drove, and the violation that weighs most.
    pub(crate) fn stability(&self, command: &Command) -> Option<(Stability, Option<Violation>)> {
        let (wanted, balanced) = (command.wanted.as_ref()?, command.balanced?);
        let watched = wanted.watched?;
        let violation = self.violation(command);
        let equation = self.equation();
        let (error, error_bound) = wanted.error.unwrap_or((0.0, f64::INFINITY));
        let robot = &self.settings.robot;
        let text = |violation: &Violation| format!("{robot}: {}: {violation}", violation.equation(equation));
        let message = Stability {
            header: Header { stamp: command.exposure.into(), frame_id: MAP.to_owned() },
            robot: robot.clone(),
            law: self.settings.law_name.clone(),
            equation: equation.to_owned(),
            value: watched.value,
            rate: watched.rate,
            sign: balanced.sign,
            bound: balanced.bound,
            error,
            error_bound,
            term: balanced.term.name().to_owned(),
            holds: violation.is_none(),
            violation: violation.as_ref().map(text).unwrap_or_default(),
        };
        Some((message, violation))
    }

    /// The number of the law in force.
    pub(crate) fn equation(&self) -> &'static str {
        self.settings
            .dynamic
            .as_ref()
            .map_or_else(|| Law::equation(&self.settings.law), |dynamic| dynamic.law.equation())
    }

    fn violation(&self, command: &Command) -> Option<Violation> {
        let (wanted, balanced) = (command.wanted.as_ref()?, command.balanced?);
        if command.limits & LeaderState::LIMIT_DEVIATES != 0 {
            return Some(Violation::Deviates);
        }
        if !balanced.holds {
            let value = wanted.watched?.value;
            return Some(Violation::Balance { value, bound: balanced.bound, term: balanced.term });
        }
        if let Some(reason) = &self.unstable_gains {
            return Some(Violation::Gains(reason.clone()));
        }
        let (zone, distance) = wanted.zone?;
        let leader = self.inputs.member(&self.settings.robot)?.leader.clone();
        let radii = *self.settings.dynamic.as_ref()?.agent.zoning.radii();
        match zone {
            Zone::Forbidden => Some(Violation::Near { leader, distance, least: radii.rho_underbar }),
            Zone::Beyond => Some(Violation::Far { leader, distance, most: radii.rho_bar }),
            _ => None,
        }
    }
}
