//! Which type a topic has, from its name.

use trench_core::{Qos, Subscribe};
use trench_msgs::TypeInfo;

/// The topics of the stack that have one name.
const SHARED: [(&str, &str, Qos); 15] = [
    ("/team_state", "trench_msgs/msg/TeamState", Qos::RELIABLE),
    ("/goals", "trench_msgs/msg/Goals", Qos::RELIABLE),
    ("/formation", "trench_msgs/msg/Formation", Qos::LATCHED),
    ("/assignment", "trench_msgs/msg/Assignment", Qos::LATCHED),
    ("/run_state", "trench_msgs/msg/RunState", Qos::LATCHED),
    ("/target", "nav_msgs/msg/Odometry", Qos::RELIABLE),
    ("/obstacles", "trench_msgs/msg/ObstacleArray", Qos::RELIABLE),
    ("/apparent_obstacles", "trench_msgs/msg/ApparentObstacleArray", Qos::RELIABLE),
    ("/emergency_stop", "std_msgs/msg/Bool", Qos::RELIABLE),
    ("/markers", "visualization_msgs/msg/MarkerArray", Qos::RELIABLE),
    ("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", Qos::RELIABLE),
    ("/tf", "tf2_msgs/msg/TFMessage", Qos::RELIABLE),
    ("/rosout", "rcl_interfaces/msg/Log", Qos::RELIABLE),
    ("/overhead/camera_info", "sensor_msgs/msg/CameraInfo", Qos::SENSOR),
    ("/overhead/image_raw", "sensor_msgs/msg/Image", Qos::SENSOR),
];

/// The topics that every robot has, by the end of their names.
const OF_A_ROBOT: [(&str, &str, Qos); 8] = [
    ("/odom", "nav_msgs/msg/Odometry", Qos::RELIABLE),
    ("/cmd_vel", "geometry_msgs/msg/TwistStamped", Qos::RELIABLE),
    ("/leader_state", "trench_msgs/msg/LeaderState", Qos::RELIABLE),
    ("/stability", "trench_msgs/msg/Stability", Qos::RELIABLE),
    ("/link", "trench_msgs/msg/LinkStatus", Qos::RELIABLE),
    ("/battery_state", "sensor_msgs/msg/BatteryState", Qos::RELIABLE),
    ("/wheel_odom", "nav_msgs/msg/Odometry", Qos::RELIABLE),
    ("/scan", "sensor_msgs/msg/LaserScan", Qos::SENSOR),
];

/// What is recorded when nothing is named: everything but images, which are large.
pub(super) fn usual(robots: &[String]) -> Vec<String> {
    let shared = SHARED.iter().map(|(name, ..)| (*name).to_owned()).filter(|name| !name.ends_with("image_raw"));
    let of_robots = robots.iter().flat_map(|robot| {
        let own = OF_A_ROBOT.iter().map(move |(end, ..)| format!("/{robot}{end}"));
        own.chain([format!("/ground_truth/{robot}/odom")])
    });
    shared.chain(of_robots).collect()
}

/// The name that `NAME` or `NAME:TYPE` asks for.
pub(super) fn name(asked: &str) -> &str {
    asked.split_once(':').map_or(asked, |(name, _)| name)
}

/// Type and quality of service of a topic of the stack.
pub(super) fn known(name: &str) -> Option<(&'static str, Qos)> {
    let shared = SHARED.iter().find(|(shared, ..)| *shared == name);
    let found = shared.or_else(|| OF_A_ROBOT.iter().find(|(end, ..)| name.ends_with(end)));
    found.map(|&(_, type_name, qos)| (type_name, qos))
}

/// The subscription that `NAME` or `NAME:TYPE` asks for, or what is wrong with it and what would be right. Nothing for
/// a name whose type is not known before somebody writes it.
pub(super) fn subscription(asked: &str) -> Result<Option<Subscribe>, (String, String)> {
    let name = name(asked);
    if !name.starts_with('/') || name.len() < 2 {
        return Err((format!("{name:?} is no absolute topic name"), "write it with a leading /".to_owned()));
    }
    let known = known(name);
    let qos = known.map_or(Qos::RELIABLE, |(_, qos)| qos);
    let named_type = asked.split_once(':').map(|(_, named_type)| named_type);
    let Some(type_name) = named_type.or(known.map(|(type_name, _)| type_name)) else { return Ok(None) };
    let type_info: &'static TypeInfo = trench_msgs::type_named(type_name)
        .ok_or_else(|| (format!("{type_name:?} is no message type of this stack"), known_types()))?;
    Ok(Some(Subscribe::of_type(name, type_info, qos)))
}

fn known_types() -> String {
    let names: Vec<_> = trench_msgs::types().iter().map(|info| info.name).filter(|n| n.contains("/msg/")).collect();
    format!("known are {}", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(asked: &str, expected: Result<(&str, &str), &str>) {
        match (subscription(asked), expected) {
            (Ok(Some(found)), Ok(expected)) => {
                assert_eq!((found.topic.as_str(), found.type_info.name), expected, "{asked}");
            }
            (Err((problem, _)), Err(expected)) => assert!(problem.contains(expected), "{asked}: {problem}"),
            (found, _) => panic!("{asked}: {found:?}"),
        }
    }

    #[test]
    fn types_are_known_by_name_or_given() {
        check("/goals", Ok(("/goals", "trench_msgs/msg/Goals")));
        check("/robot1/cmd_vel", Ok(("/robot1/cmd_vel", "geometry_msgs/msg/TwistStamped")));
        check("/ground_truth/robot7/odom", Ok(("/ground_truth/robot7/odom", "nav_msgs/msg/Odometry")));
        check("/robot1/cmd_vel:geometry_msgs/msg/Twist", Ok(("/robot1/cmd_vel", "geometry_msgs/msg/Twist")));
        check("/stop:std_msgs/msg/Bool", Ok(("/stop", "std_msgs/msg/Bool")));
        check("/stop:std_msgs/msg/Nothing", Err("no message type"));
        check("odom", Err("no absolute topic name"));
        check("/", Err("no absolute topic name"));
        assert!(matches!(subscription("/stop"), Ok(None)), "its writer will tell");
    }

    #[test]
    fn the_usual_topics_are_all_known() {
        let usual = usual(&["robot1".to_owned()]);
        for name in &usual {
            assert!(matches!(subscription(name), Ok(Some(_))), "{name}");
        }
        assert!(!usual.iter().any(|name| name.ends_with("image_raw")), "images are large");
        assert!(usual.contains(&"/ground_truth/robot1/odom".to_owned()));
    }
}
