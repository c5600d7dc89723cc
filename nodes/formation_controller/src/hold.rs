//! Reasons to rest.

use std::fmt;
use trench_core::Condition;
use trench_msgs::msg::RobotState;

/// Why the robot is told to rest.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Hold {
    NotRunning,
    EmergencyStop,
    NoTeamState,
    NotSeen(u8),
    OldPose(f64),
    NoGoal,
    /// The assignment or the formation that the goals are for has not come.
    NoPlace,
    /// The robot ahead of this name is silent.
    NoLeader(String),
    NoMapper,
    NotFinite,
    /// Somebody else drives the robot, too.
    TwoControllers,
}

impl Hold {
    pub(crate) fn condition(&self) -> Condition {
        match self {
            Self::NotRunning => Condition::Ok,
            Self::NoTeamState | Self::OldPose(_) | Self::NoGoal | Self::NoPlace | Self::NoLeader(_) => Condition::Stale,
            Self::EmergencyStop | Self::NotSeen(_) | Self::NoMapper | Self::NotFinite | Self::TwoControllers => {
                Condition::Error
            }
        }
    }
}

impl fmt::Display for Hold {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotRunning => write!(formatter, "resting: the run is not running"),
            Self::EmergencyStop => write!(formatter, "resting: emergency stop"),
            Self::NoTeamState => write!(formatter, "resting: no team state with this robot was heard"),
            Self::NotSeen(RobotState::STATUS_AMBIGUOUS) => write!(formatter, "resting: which robot it is, is in doubt"),
            Self::NotSeen(_) => write!(formatter, "resting: the localizer has lost the robot"),
            Self::OldPose(age) => write!(formatter, "resting: the pose is {age:.3} s old"),
            Self::NoGoal => write!(formatter, "resting: no goal is heard"),
            Self::NoPlace => write!(formatter, "resting: the assignment or formation of the goals is not heard"),
            Self::NoLeader(name) => write!(formatter, "resting: {name}, ahead in the chain, is silent"),
            Self::NoMapper => write!(formatter, "resting: no obstacle mapper is heard"),
            Self::TwoControllers => write!(formatter, "resting: two controllers drive this robot; end one of them"),
            Self::NotFinite => write!(formatter, "resting: the law gave a number that is not finite"),
        }
    }
}
