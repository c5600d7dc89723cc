//! Laws that are chosen by a file.

use trench_formation::avoidance::{GoalPotential, VelocityPotential};
use trench_formation::kinematics::{PointState, Polar, Twist};
use trench_formation::laws::{Direct, Family, GoalMotion, GoalTracking, Nominal, PointLaw, Robust, Steered};
use trench_formation::trench::{AnyDamping, AnyTrench};

/// A law of chapter 4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ChosenLaw {
    /// (3.9).
    Direct(Direct),
    /// (3.10).
    Nominal(Nominal),
    /// (3.13).
    Robust(Robust),
    /// (4.4).
    Family(Family),
}

impl PointLaw for ChosenLaw {
    fn twist(&self, polar: Polar) -> Twist {
        match self {
            Self::Direct(law) => law.twist(polar),
            Self::Nominal(law) => law.twist(polar),
            Self::Robust(law) => law.twist(polar),
            Self::Family(law) => law.twist(polar),
        }
    }
}

/// What draws a double integrator to its goal point: the law of chapter 5, or those that 5.5 compares it with.
#[derive(Debug, Clone, PartialEq)]
pub enum GoalLaw {
    /// (5.1), (5.2) with a damping that depends on the distance, and (5.3) for goal points at rest.
    Trench(GoalTracking<AnyTrench, AnyDamping>),
    /// (5.4).
    Conventional(GoalPotential),
    /// (5.5).
    Velocity(VelocityPotential),
}

impl GoalLaw {
    /// The acceleration of a robot that tracks `goal`.
    #[must_use]
    pub fn steer(&self, robot: PointState, goal: GoalMotion) -> Steered {
        match self {
            Self::Trench(law) => law.steer(robot, goal),
            Self::Conventional(law) => law.steer(robot, goal),
            Self::Velocity(law) => law.steer(robot, goal),
        }
    }
}
