//! Which topics make the picture, and what each is to it.

use trench_core::{Qos, Subscribe};
use trench_msgs::Message;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::{
    ApparentObstacleArray, Assignment, Formation, Goals, LeaderState, LinkStatus, ObstacleArray, RunState, Stability,
    TeamState,
};
use trench_msgs::nav_msgs::Odometry;
use trench_msgs::std_msgs::Bool;
use trench_msgs::visualization_msgs::MarkerArray;

/// What a topic is to the picture. Those of one robot carry its name.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// /team_state: where the robots are.
    Team,
    /// /goals.
    Goals,
    /// /formation.
    Formation,
    /// /assignment: who follows whom.
    Assignment,
    /// /run_state.
    RunState,
    /// /target: carries formations in its frame.
    Target,
    /// /obstacles.
    Obstacles,
    /// /apparent_obstacles: the hulls.
    Hulls,
    /// /emergency_stop.
    EmergencyStop,
    /// /markers, as far as nothing else draws it better.
    Markers,
    /// /diagnostics: the alarms.
    Diagnostics,
    /// /ground_truth/contacts: collisions of the simulated bed.
    Contacts,
    /// `<r>/leader_state`: how its law is doing.
    Leader(String),
    /// `<r>/stability`: whether the law's stability argument holds.
    Stability(String),
    /// `<r>/link`.
    Link(String),
    /// `/ground_truth/<r>/odom`.
    Truth(String),
}

/// Name, role, how to subscribe.
type Shared = (&'static str, Role, fn(&str) -> Subscribe);

const SHARED: [Shared; 11] = [
    ("/team_state", Role::Team, |topic| Subscribe::to::<TeamState>(topic, Qos::RELIABLE)),
    ("/goals", Role::Goals, |topic| Subscribe::to::<Goals>(topic, Qos::RELIABLE)),
    ("/formation", Role::Formation, |topic| Subscribe::to::<Formation>(topic, Qos::LATCHED)),
    ("/assignment", Role::Assignment, |topic| Subscribe::to::<Assignment>(topic, Qos::LATCHED)),
    ("/run_state", Role::RunState, |topic| Subscribe::to::<RunState>(topic, Qos::LATCHED)),
    ("/target", Role::Target, |topic| Subscribe::to::<Odometry>(topic, Qos::RELIABLE)),
    ("/obstacles", Role::Obstacles, |topic| Subscribe::to::<ObstacleArray>(topic, Qos::RELIABLE)),
    ("/apparent_obstacles", Role::Hulls, |topic| Subscribe::to::<ApparentObstacleArray>(topic, Qos::RELIABLE)),
    ("/emergency_stop", Role::EmergencyStop, |topic| Subscribe::to::<Bool>(topic, Qos::RELIABLE)),
    ("/markers", Role::Markers, |topic| Subscribe::to::<MarkerArray>(topic, Qos::RELIABLE)),
    ("/diagnostics", Role::Diagnostics, |topic| Subscribe::to::<DiagnosticArray>(topic, Qos::RELIABLE)),
];

const CONTACTS: &str = "/ground_truth/contacts";

impl Role {
    /// The role of a recorded topic; none where it is nothing to the picture, or its type is not the one we know.
    #[must_use]
    pub fn of(topic: &str, type_name: &str) -> Option<Self> {
        let of_a_robot = |before: &str, end: &str, type_info: &trench_msgs::TypeInfo| {
            let robot = topic.strip_prefix(before)?.strip_suffix(end)?;
            (type_info.name == type_name && !robot.is_empty()).then(|| robot.to_owned())
        };
        if let Some((name, role, subscribe)) = SHARED.iter().find(|(name, ..)| *name == topic) {
            return (subscribe(name).type_info.name == type_name).then(|| role.clone());
        }
        if topic == CONTACTS {
            return (type_name == DiagnosticArray::TYPE.name).then_some(Self::Contacts);
        }
        of_a_robot("/ground_truth/", "/odom", Odometry::TYPE)
            .map(Self::Truth)
            .or_else(|| of_a_robot("/", "/leader_state", LeaderState::TYPE).map(Self::Leader))
            .or_else(|| of_a_robot("/", "/stability", Stability::TYPE).map(Self::Stability))
            .or_else(|| of_a_robot("/", "/link", LinkStatus::TYPE).map(Self::Link))
    }

    /// Whether a browser that comes late needs the last message however old it is.
    pub(crate) fn is_lasting(&self) -> bool {
        matches!(self, Self::Formation | Self::Assignment | Self::RunState | Self::EmergencyStop | Self::Obstacles)
    }

    /// Whether the history keeps something of its messages.
    pub(crate) fn has_history(&self) -> bool {
        matches!(self, Self::Team | Self::Leader(_) | Self::Stability(_))
    }
}

/// What a viewer of these robots subscribes to, with each topic's role. `with_truth`: ground truth of the simulated
/// bed too.
#[must_use]
pub fn subscriptions(robots: &[String], with_truth: bool) -> Vec<(Role, Subscribe)> {
    let mut all: Vec<_> = SHARED.iter().map(|(name, role, subscribe)| (role.clone(), subscribe(name))).collect();
    for robot in robots {
        let leader = Subscribe::to::<LeaderState>(format!("/{robot}/leader_state"), Qos::RELIABLE);
        all.push((Role::Leader(robot.clone()), leader));
        let stability = Subscribe::to::<Stability>(format!("/{robot}/stability"), Qos::RELIABLE);
        all.push((Role::Stability(robot.clone()), stability));
        let link = Subscribe::to::<LinkStatus>(format!("/{robot}/link"), Qos::RELIABLE);
        all.push((Role::Link(robot.clone()), link));
        if with_truth {
            let odometry = Subscribe::to::<Odometry>(format!("/ground_truth/{robot}/odom"), Qos::RELIABLE);
            all.push((Role::Truth(robot.clone()), odometry));
        }
    }
    if with_truth {
        all.push((Role::Contacts, Subscribe::to::<DiagnosticArray>(CONTACTS, Qos::RELIABLE)));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_subscribed_is_known_by_its_name_in_a_bag() {
        let all = subscriptions(&["robot1".to_owned(), "left/2".to_owned()], true);
        assert_eq!(all.len(), SHARED.len() + 2 * 4 + 1);
        for (role, subscribe) in all {
            assert_eq!(Role::of(&subscribe.topic, subscribe.type_info.name), Some(role), "{}", subscribe.topic);
            assert_eq!(Role::of(&subscribe.topic, "std_msgs/msg/String"), None, "{}", subscribe.topic);
        }
        assert_eq!(Role::of("/robot1/cmd_vel", "geometry_msgs/msg/TwistStamped"), None);
    }
}
