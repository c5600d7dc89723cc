//! V = (|e|^2 + phi^2)/2 of chapter 4.

use super::{Function, Watched};
use trench_formation::Vector2;
use trench_formation::agent::RemedyState;
use trench_formation::kinematics::{Pose, Twist};
use trench_formation::laws::{GoalMotion, Tracked};
use trench_formation::stability::{Input, Supply};

/// Nearer than this (m) the direction to the goal point is noise.
const NEAR: f64 = 0.01;

/// What a law expects the robot to do up to the next tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Expected {
    twist: Twist,
    /// s
    duration: f64,
}

impl Expected {
    /// What it brings into V, with the gradient by position and heading, that the robot at `pose` follows `sent` instead.
    pub(crate) fn missed(&self, (along, turning): (Vector2<f64>, f64), pose: Pose, sent: Twist) -> f64 {
        let (v, omega) = (sent.v - self.twist.v, sent.omega - self.twist.omega);
        self.duration * (v * along.dot(&pose.heading()) + omega * turning)
    }
}

/// What a law of chapter 4 says at `pose`, for `duration` (s). `wanted` is the velocity from which phi is measured, with its
/// derivative by the position, 1/s: (e, 1) but for laws that feed the goal's velocity forward.
pub(crate) fn watched(
    tracked: &Tracked,
    (pose, goal, phase): (Pose, GoalMotion, u8),
    feed: Option<f64>,
    epoch: u64,
    duration: f64,
) -> Watched {
    let error = goal.position - pose.position();
    let (wanted, slope) = feed.map_or((error, 1.0), |k1| (goal.velocity + k1 * error, k1));
    let reach = wanted.norm() / slope;
    let near = tracked.holding || reach < NEAR;
    let across = Vector2::new(-wanted.y, wanted.x) / wanted.norm().max(f64::MIN_POSITIVE);
    let phi = if near { 0.0 } else { tracked.misalignment };
    let gradient = if near { -error } else { -error + phi / reach * across };
    let mut supply = Supply::default();
    supply.add(Input::Law, duration * tracked.lyapunov.rate);
    // Laws for resting goal points do not know that theirs moves.
    let unknown = if feed.is_some() { Vector2::zeros() } else { goal.velocity };
    supply.add(Input::Frame, -duration * gradient.dot(&unknown));
    Watched {
        function: Function { law: None, epoch, draws: true, remedy: RemedyState::None, goal: (phase, near) },
        value: tracked.lyapunov.value,
        rate: tracked.lyapunov.rate,
        gradient: (gradient, phi),
        news: Supply::default(),
        supply,
        expected: Some(Expected { twist: tracked.twist, duration }),
    }
}
