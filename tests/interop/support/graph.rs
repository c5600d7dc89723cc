//! The graph of the launched square: what each topic is, who publishes it, who reads it.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

const ROBOTS: [&str; 4] = ["robot1", "robot2", "robot3", "robot4"];

// Words of the table for several nodes: the robots' controllers, and everyone.
const CONTROLLERS: &str = "CONTROLLERS";
const ALL: &str = "ALL";

/// Nodes besides the controllers.
const NODES: [&str; 7] =
    [LAUNCHER, "/leader_assignment", "/obstacle_mapper", "/operator", "/overhead_localizer", "/rf_bridge", "/testbed"];

/// The node of `trench launch` itself: here without its host and process id.
const LAUNCHER: &str = "/launch";

/// Topic (`*` is each robot), type, publishers, subscribers.
const TOPICS: [(&str, &str, &str, &str); 32] = [
    ("/overhead/image_raw", "sensor_msgs/msg/Image", "/testbed", "/overhead_localizer"),
    ("/overhead/camera_info", "sensor_msgs/msg/CameraInfo", "/testbed", ""),
    ("/ground_truth/*/odom", "nav_msgs/msg/Odometry", "/testbed", ""),
    ("/ground_truth/contacts", "diagnostic_msgs/msg/DiagnosticArray", "/testbed", ""),
    ("/team_state", "trench_msgs/msg/TeamState", "/overhead_localizer", "/leader_assignment /operator CONTROLLERS"),
    ("/*/odom", "nav_msgs/msg/Odometry", "/overhead_localizer", ""),
    ("/tf", "tf2_msgs/msg/TFMessage", "/overhead_localizer", ""),
    ("/identify", "trench_msgs/msg/Identify", "/overhead_localizer", "/rf_bridge CONTROLLERS"),
    ("/loop_delay", "std_msgs/msg/Float64", "/overhead_localizer", "CONTROLLERS"),
    ("/target", "nav_msgs/msg/Odometry", "", "/leader_assignment"),
    ("/set_formation", "trench_msgs/msg/Formation", "", "/leader_assignment"),
    ("/formation", "trench_msgs/msg/Formation", "/leader_assignment", "CONTROLLERS"),
    ("/assignment", "trench_msgs/msg/Assignment", "/leader_assignment", "CONTROLLERS"),
    ("/goals", "trench_msgs/msg/Goals", "/leader_assignment", "/operator CONTROLLERS"),
    ("/run_state", "trench_msgs/msg/RunState", "/leader_assignment", "/operator /rf_bridge CONTROLLERS"),
    ("/*/leader_state", "trench_msgs/msg/LeaderState", "/*/formation_controller", "/leader_assignment CONTROLLERS"),
    ("/*/stability", "trench_msgs/msg/Stability", "/*/formation_controller", ""),
    ("/*/cmd_vel", "geometry_msgs/msg/TwistStamped", "/*/formation_controller", "/rf_bridge"),
    ("/obstacles", "trench_msgs/msg/ObstacleArray", "", "/obstacle_mapper"),
    ("/apparent_obstacles", "trench_msgs/msg/ApparentObstacleArray", "/obstacle_mapper", "CONTROLLERS"),
    (
        "/markers",
        "visualization_msgs/msg/MarkerArray",
        "/leader_assignment /obstacle_mapper /overhead_localizer CONTROLLERS",
        "",
    ),
    ("/*/link", "trench_msgs/msg/LinkStatus", "/rf_bridge", "/leader_assignment /*/formation_controller"),
    ("/*/battery_state", "sensor_msgs/msg/BatteryState", "/rf_bridge", ""),
    ("/*/wheel_odom", "nav_msgs/msg/Odometry", "/rf_bridge", ""),
    ("/*/range_0", "sensor_msgs/msg/Range", "/rf_bridge", ""),
    ("/*/range_1", "sensor_msgs/msg/Range", "/rf_bridge", ""),
    ("/*/range_2", "sensor_msgs/msg/Range", "/rf_bridge", ""),
    ("/*/range_3", "sensor_msgs/msg/Range", "/rf_bridge", ""),
    ("/emergency_stop", "std_msgs/msg/Bool", "", "/rf_bridge CONTROLLERS"),
    (
        "/diagnostics",
        "diagnostic_msgs/msg/DiagnosticArray",
        "/launch /leader_assignment /obstacle_mapper /overhead_localizer /rf_bridge /testbed CONTROLLERS",
        "",
    ),
    ("/rosout", "rcl_interfaces/msg/Log", "ALL", ""),
    ("/parameter_events", "rcl_interfaces/msg/ParameterEvent", "ALL", ""),
];

/// Latched topics: a late joiner gets them.
pub(crate) const LATCHED: [&str; 4] = ["/formation", "/assignment", "/run_state", "/rosout"];

/// A topic with type and ends.
type Topic = (String, BTreeSet<String>, BTreeSet<String>);

/// Asserts that nodes, topics, types and ends are those of the table, and no others.
pub(crate) fn check(graph: &Value) {
    let nodes = graph["nodes"].as_array().unwrap().iter().filter_map(Value::as_str);
    assert_eq!(nodes.map(plain).collect::<BTreeSet<_>>(), all());
    let (expected, seen) = (expected(), seen(graph));
    for (name, topic) in &expected {
        assert_eq!(seen.get(name), Some(topic), "{name}");
    }
    for (name, (kind, ..)) in &seen {
        assert!(expected.contains_key(name), "{name} of type {kind} is not in the table");
    }
    for name in LATCHED {
        let ends = graph["topics"][name]["publishers"].as_array().unwrap();
        assert!(ends.iter().all(|end| end["durability"] == "transient_local"), "{name}: {ends:?}");
    }
}

/// Whether it is the node of a `trench launch`.
pub(crate) fn is_launcher(node: &str) -> bool {
    node.starts_with("/launch_")
}

fn plain(node: &str) -> String {
    if is_launcher(node) { LAUNCHER.to_owned() } else { node.to_owned() }
}

fn seen(graph: &Value) -> BTreeMap<String, Topic> {
    let topics = graph["topics"].as_object().unwrap().iter();
    let topics = topics.map(|(name, topic)| {
        let types = topic["types"].as_array().unwrap();
        assert_eq!(types.len(), 1, "{name} has types {types:?}");
        let kind = types[0].as_str().unwrap();
        let ends = |which: &str| -> BTreeSet<String> {
            let ends = topic[which].as_array().unwrap().iter();
            let ours = ends.filter(|end| !end["node"].as_str().unwrap().starts_with("/peer_"));
            ours.map(|end| {
                assert_eq!(end["type"], kind, "{name}");
                plain(end["node"].as_str().unwrap())
            })
            .collect()
        };
        (name.clone(), (kind.to_owned(), ends("publishers"), ends("subscribers")))
    });
    topics.collect()
}

fn expected() -> BTreeMap<String, Topic> {
    let mut topics = BTreeMap::new();
    for (name, kind, publishers, subscribers) in TOPICS {
        let robots = if name.contains('*') { &ROBOTS[..] } else { &ROBOTS[..1] };
        for robot in robots {
            let topic = (kind.to_owned(), nodes(publishers, robot), nodes(subscribers, robot));
            topics.insert(name.replace('*', robot), topic);
        }
    }
    topics
}

fn nodes(words: &str, robot: &str) -> BTreeSet<String> {
    let one = |word: &str| -> BTreeSet<String> {
        match word {
            ALL => all(),
            CONTROLLERS => controllers(),
            name => BTreeSet::from([name.replace('*', robot)]),
        }
    };
    words.split_whitespace().flat_map(one).collect()
}

fn all() -> BTreeSet<String> {
    controllers().into_iter().chain(NODES.map(str::to_owned)).collect()
}

fn controllers() -> BTreeSet<String> {
    ROBOTS.iter().map(|robot| format!("/{robot}/formation_controller")).collect()
}
