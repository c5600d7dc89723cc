//! Names of topics and types as DDS carries them.

/// A topic as DDS names it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct DdsName {
    pub(super) topic: String,
    pub(super) type_name: String,
}

impl DdsName {
    /// `/team_state` of type `trench_msgs/msg/TeamState`.
    pub(super) fn message(topic: &str, type_name: &str) -> Self {
        Self { topic: format!("rt{topic}"), type_name: dds_type(type_name, "") }
    }

    /// The requests of service `/node/arm` of type `std_srvs/srv/Trigger`.
    pub(super) fn request(service: &str, type_name: &str) -> Self {
        Self { topic: format!("rq{service}Request"), type_name: dds_type(type_name, "_Request") }
    }

    /// The responses of the same service.
    pub(super) fn response(service: &str, type_name: &str) -> Self {
        Self { topic: format!("rr{service}Reply"), type_name: dds_type(type_name, "_Response") }
    }
}

/// `package/msg/Name` is `package::msg::dds_::Name_` on the network.
fn dds_type(ros: &str, suffix: &str) -> String {
    match ros.rsplit_once('/') {
        Some((package, name)) => format!("{}::dds_::{name}{suffix}_", package.replace('/', "::")),
        None => format!("dds_::{ros}{suffix}_"),
    }
}

/// The topic as ROS names it; nothing for what is no topic of ROS (services, DDS's own).
pub(super) fn ros_topic(topic: &str) -> Option<&str> {
    topic.strip_prefix("rt").filter(|topic| topic.starts_with('/'))
}

/// The type as ROS names it; what is none of ROS stays as it is.
pub(super) fn ros_type(type_name: &str) -> String {
    let parts =
        type_name.split_once("::msg::dds_::").and_then(|(package, name)| Some((package, name.strip_suffix('_')?)));
    parts.map_or_else(|| type_name.to_owned(), |(package, name)| format!("{package}/msg/{name}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_on_the_network_are_those_of_ros() {
        let check = |name: DdsName, topic: &str, type_name: &str| {
            assert_eq!((name.topic.as_str(), name.type_name.as_str()), (topic, type_name));
        };
        check(DdsName::message("/tf", "tf2_msgs/msg/TFMessage"), "rt/tf", "tf2_msgs::msg::dds_::TFMessage_");
        assert_eq!(ros_topic("rt/tf"), Some("/tf"));
        assert_eq!(ros_topic("rq/a/armRequest"), None);
        assert_eq!(ros_topic("ros_discovery_info"), None);
        assert_eq!(ros_type("tf2_msgs::msg::dds_::TFMessage_"), "tf2_msgs/msg/TFMessage");
        assert_eq!(ros_type("Shape"), "Shape");
        let trigger = "std_srvs/srv/Trigger";
        check(DdsName::request("/a/arm", trigger), "rq/a/armRequest", "std_srvs::srv::dds_::Trigger_Request_");
        check(DdsName::response("/a/arm", trigger), "rr/a/armReply", "std_srvs::srv::dds_::Trigger_Response_");
    }
}
