//! The safety filter that ends every law (docs/ARCHITECTURE.md, "safe by default").
//!
//! [`SafetyFilter::apply`] is a pure function of one robot's surroundings. It passes a twist on bit for bit unless the
//! twist breaks the rule or the straight way to the goal is blocked; then it heads for the way round and limits the
//! speed by the rule. A robot is a disc about its axle's centre, so turning on the spot is always safe.
mod detour;
mod evade;
mod limit;
mod parameters;
mod scene;
mod stopping;

pub use detour::Side;
pub use parameters::{SafetyParameterError, SafetyParameters};
pub use scene::{Constraint, MovingOutline, Neighbour, Scene};
pub use stopping::{Line, Passing, Stopping};

use crate::kinematics::{Pose, Twist, wrap};
use nalgebra::Vector2;

/// Gain (1/s) and limit (rad/s) of the turn towards a way round.
const TURN_GAIN: f64 = 4.0;
const MOST_TURN: f64 = 2.5;

/// What a law wants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wish {
    /// The law's twist.
    pub twist: Twist,
    /// Where the law drives to, m, frame `map`. Without it the filter slows and stops, but does not lead round.
    pub goal: Option<Vector2<f64>>,
    /// The side of the last way round, [`Filtered::side`], for robots that are not to change their minds.
    pub kept: Option<Side>,
    /// How fast the law drives at this distance where nothing is in the way, m/s: the speed on a way round, where that is more than
    /// the twist's own and than the least that there is.
    pub pace: f64,
}

/// What is sent instead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Filtered {
    /// The twist to send.
    pub twist: Twist,
    /// What made it differ from the wish; `None` if the wish is passed on bit for bit.
    pub acted: Option<Constraint>,
    /// The side of the way round, if there is one.
    pub side: Option<Side>,
}

/// The filter of one robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SafetyFilter {
    parameters: SafetyParameters,
}

impl SafetyFilter {
    /// A filter for a robot and its loop.
    ///
    /// # Errors
    /// A parameter that is not finite, or not positive where it must be.
    pub fn new(parameters: SafetyParameters) -> Result<Self, SafetyParameterError> {
        parameters.check()?;
        Ok(Self { parameters })
    }

    /// The twist to send for a robot at `pose` that moves with twist `now` and whose law wants `wish`.
    pub fn apply(&self, pose: Pose, now: Twist, wish: Wish, scene: &Scene<'_>) -> Filtered {
        let place_known = (pose.x + pose.y + pose.theta).is_finite() && now.is_finite();
        let wish_known = wish.twist.is_finite()
            && wish.pace.is_finite()
            && wish.goal.is_none_or(|goal| (goal.x + goal.y).is_finite());
        if !(place_known && wish_known && scene.is_finite()) {
            return Filtered { twist: Twist::ZERO, acted: Some(Constraint::NotFinite), side: None };
        }
        let pace = self.pace(wish);
        if let Some(evasion) = evade::evasion(&self.parameters, scene, pose.position(), pace) {
            let wanted = self.give_way(pose, pace.max(2.0 * evasion.speed), evasion.direction);
            let (twist, decisive) = limit::limit(&self.parameters, scene, pose, now, wanted);
            return Filtered { twist, acted: decisive.or(Some(evasion.threat)), side: None };
        }
        let detour = wish.goal.and_then(|goal| {
            let centre = pose.position();
            detour::View { scene, parameters: &self.parameters, centre, goal, kept: wish.kept, pace }
                .with_goal_uncovered()
                .detour()
        });
        let (wanted, blocker, side) = match detour {
            Some(detour) => (self.steer(pose, pace, detour.direction), Some(detour.blocker), Some(detour.side)),
            None => (wish.twist, None, None),
        };
        let (twist, decisive) = limit::limit(&self.parameters, scene, pose, now, wanted);
        Filtered { twist, acted: decisive.or(blocker), side }
    }

    /// Speed on a way round, m/s.
    fn pace(&self, wish: Wish) -> f64 {
        wish.twist.v.abs().max(wish.pace).max(self.parameters.detour_speed)
    }

    /// Twist that turns the robot towards `direction`, at speed only once it faces there.
    fn steer(&self, pose: Pose, pace: f64, direction: Vector2<f64>) -> Twist {
        let error = wrap(libm::atan2(direction.y, direction.x) - pose.theta);
        let facing = libm::cos(error).max(0.0);
        Twist { v: pace * facing * facing * facing, omega: (TURN_GAIN * error).clamp(-MOST_TURN, MOST_TURN) }
    }

    /// The same forwards or backwards, whichever needs the smaller turn.
    fn give_way(&self, pose: Pose, pace: f64, direction: Vector2<f64>) -> Twist {
        let (sine, cosine) = libm::sincos(pose.theta);
        if direction.dot(&Vector2::new(cosine, sine)) >= 0.0 {
            return self.steer(pose, pace, direction);
        }
        let forwards = self.steer(pose, pace, -direction);
        Twist { v: -forwards.v, ..forwards }
    }
}
