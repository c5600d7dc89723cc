//! Control laws of chapters 3 to 8.
//!
//! The kinematic laws are pure functions of [`Polar`]; [`Tracking`] carries (3.13) over to goal points that move.
mod dead_band;
mod direct;
mod family;
mod goal_tracking;
mod lyapunov;
mod nearest;
mod nominal;
mod push;
mod queue;
mod rigid_motion;
mod robust;
mod saturation;
mod tracking;
mod zoned;

use crate::kinematics::{Polar, Twist};

pub use dead_band::DeadBand;
pub use direct::Direct;
pub use family::Family;
pub(crate) use goal_tracking::pull;
pub use goal_tracking::{Capability, GoalTracking, Steered};
pub use lyapunov::Lyapunov;
pub use nearest::{Attracting, NearestAttraction};
pub(crate) use nearest::{Seen, Unpushed};
pub use nominal::Nominal;
pub use push::Push;
pub use queue::QueueFollowing;
pub use rigid_motion::RigidMotion;
pub use robust::Robust;
pub use saturation::Terms;
pub use tracking::{GoalMotion, Tracked, Tracking};
pub use zoned::{Attraction, ZonedAttraction};

/// A point tracking law of chapter 4: the velocity it commands at given polar coordinates of a resting goal point.
pub trait PointLaw {
    /// v and omega at r and phi.
    fn twist(&self, polar: Polar) -> Twist;
}
