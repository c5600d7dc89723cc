//! The linear queue laws (8.7) and (8.11) in the form that a double integrator can realise.
use crate::Vector2;
use crate::kinematics::PointState;
use crate::stability::QueueRobot;

/// u = K e with e = x_leader - x - (d, 0): beta = 0 and A d = 0 in (8.11). (8.7) is the same with the resting nearest point in the
/// place of the leader and d = 0.
///
/// e_j' = F e_j + B K e_{j-1}: see [`Coupling::Realisable`](crate::stability::Coupling::Realisable).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QueueFollowing {
    /// First element of K, 1/s^2.
    pub position_gain: f64,
    /// Second element of K, 1/s.
    pub velocity_gain: f64,
}

impl QueueFollowing {
    /// The law that gives each axis the closed-loop poles `-first` and `-second` (1/s).
    pub fn with_poles(first: f64, second: f64) -> Self {
        Self { position_gain: first * second, velocity_gain: first + second }
    }

    /// The acceleration of a robot that keeps `spacing` (m, the vector to the leader from the place behind it, frame `map`).
    pub fn acceleration(&self, robot: PointState, leader: PointState, spacing: Vector2<f64>) -> Vector2<f64> {
        self.position_gain * (leader.position - robot.position - spacing)
            + self.velocity_gain * (leader.velocity - robot.velocity)
    }

    /// One axis of a robot under this law, for the bounds of chapter 8. They hold for the error of both axes together: the
    /// axes are alike and do not mix, so norms in the plane are those on a line.
    pub fn model(&self) -> QueueRobot {
        QueueRobot::double_integrator_with(self.position_gain, self.velocity_gain)
    }
}
