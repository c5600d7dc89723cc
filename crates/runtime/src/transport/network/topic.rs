//! A topic with its type, as ROS names them.

use trench_msgs::TypeInfo;

/// What one end of a topic must say to find the others.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct TopicName {
    topic: String,
    type_info: &'static TypeInfo,
}

impl TopicName {
    /// `/team_state` of type `trench_msgs/msg/TeamState`.
    pub(crate) fn new(topic: impl Into<String>, type_info: &'static TypeInfo) -> Self {
        Self { topic: topic.into(), type_info }
    }

    /// The absolute name, `/team_state`.
    pub(crate) fn topic(&self) -> &str {
        &self.topic
    }

    /// The type, `trench_msgs/msg/TeamState`.
    pub(crate) fn type_name(&self) -> &'static str {
        self.type_info.name
    }

    /// The type's hash, `RIHS01_...`.
    pub(crate) fn type_hash(&self) -> &'static str {
        self.type_info.hash
    }
}
