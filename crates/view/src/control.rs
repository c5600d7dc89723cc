//! How each robot's law is doing, from its leader state.

use crate::{Point, point, short};
use serde::Serialize;
use trench_msgs::msg::{LeaderState, Stability};

/// One controller's tick.
#[derive(Debug, Clone, Default, Serialize)]
pub(crate) struct Control {
    goal: Point,
    /// m.
    goal_distance: Option<f64>,
    /// m; nothing where the law knows no segment.
    segment_distance: Option<f64>,
    conforms: bool,
    /// m/s, in the map.
    velocity: Point,
    /// m/s^2: the direction in which the law pushes.
    force: Point,
    /// V.
    pub(crate) value: Option<f64>,
    rate: Option<f64>,
    limits: Vec<&'static str>,
}

const LIMITS: [(u8, &str); 5] = [
    (LeaderState::LIMIT_WHEELS, "wheels"),
    (LeaderState::LIMIT_RAMP, "ramp"),
    (LeaderState::LIMIT_SAFETY, "safety"),
    (LeaderState::LIMIT_STALE, "stale"),
    (LeaderState::LIMIT_DEVIATES, "deviates"),
];

impl Control {
    pub(crate) fn of(state: &LeaderState) -> Self {
        Self {
            goal: point(state.goal.x, state.goal.y),
            goal_distance: short(state.goal_distance),
            segment_distance: short(state.segment_distance),
            conforms: state.conforms,
            velocity: point(state.velocity.x, state.velocity.y),
            force: point(state.acceleration.x, state.acceleration.y),
            value: significant(state.lyapunov),
            rate: significant(state.lyapunov_rate),
            limits: LIMITS.iter().filter(|(bit, _)| state.limited_by & bit != 0).map(|(_, name)| *name).collect(),
        }
    }
}

/// Whether a law's stability argument holds.
#[derive(Debug, Clone, Default, Serialize)]
pub(crate) struct Monitor {
    law: String,
    equation: String,
    /// V, and what it may be at most.
    pub(crate) value: Option<f64>,
    pub(crate) bound: Option<f64>,
    /// The input that brings in most.
    term: String,
    pub(crate) holds: bool,
    /// Empty while it holds.
    pub(crate) violation: String,
}

impl Monitor {
    pub(crate) fn of(stability: &Stability) -> Self {
        Self {
            law: stability.law.clone(),
            equation: stability.equation.clone(),
            value: significant(stability.value),
            bound: significant(stability.bound),
            term: stability.term.clone(),
            holds: stability.holds,
            violation: stability.violation.clone(),
        }
    }
}

/// A value of any size, to five digits; nothing where it is no number.
pub(crate) fn significant(value: f64) -> Option<f64> {
    value.is_finite().then(|| format!("{value:.4e}").parse().unwrap_or(value))
}
