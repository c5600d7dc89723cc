//! Which law steers, by its equation.

use trench_formation::laws::{GoalTracking, NearestAttraction, ZonedAttraction};
use trench_formation::trench::{AnyTrench, ConstantDamping, CriticallyDamped, HyperbolicDamping};

/// A law for double integrators, as chosen by the parameter `law`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum DynamicLaw {
    /// (5.1): to the goal point, whose velocity and acceleration are fed forward.
    Goal(GoalTracking<AnyTrench, ConstantDamping>),
    /// (5.2): the same with damping that depends on the distance, critically damped.
    GoalDamped(GoalTracking<CriticallyDamped<HyperbolicDamping>, HyperbolicDamping>),
    /// (5.3): (5.1) to a goal point that is taken to rest.
    GoalAtRest(GoalTracking<AnyTrench, ConstantDamping>),
    /// (6.1): across the segment in a chain with zones; the chain leader follows (5.1).
    Zoned(ZonedAttraction<AnyTrench>),
    /// (7.4): to the nearest point of the segment.
    Nearest(NearestAttraction<AnyTrench>),
    /// (7.13): the same in a chain with zones; the chain leader is drawn to its goal point.
    Chain(NearestAttraction<AnyTrench>),
}

impl DynamicLaw {
    /// Its number in the thesis.
    pub(crate) fn equation(&self) -> &'static str {
        match self {
            Self::Goal(_) => "(5.1)",
            Self::GoalDamped(_) => "(5.2)",
            Self::GoalAtRest(_) => "(5.3)",
            Self::Zoned(_) => "(6.1)",
            Self::Nearest(_) => "(7.4)",
            Self::Chain(_) => "(7.13)",
        }
    }

    /// Whether robots ahead matter.
    pub(crate) fn is_chained(&self) -> bool {
        matches!(self, Self::Zoned(_) | Self::Chain(_))
    }

    /// Whether the segment is needed, for a robot of this rank.
    pub(crate) fn seeks(&self, rank: u32) -> bool {
        matches!(self, Self::Nearest(_)) || (self.is_chained() && rank > 1)
    }
}
