//! What definitions say beyond fields: constants, first values, borrowed keywords, the text in bags.

use trench_msgs::dynamic::Schema;
use trench_msgs::geometry_msgs::{PoseStamped, Quaternion};
use trench_msgs::msg::{LeaderState, Segment};
use trench_msgs::rcl_interfaces::ListParametersRequest;
use trench_msgs::std_srvs::Trigger;
use trench_msgs::visualization_msgs::Marker;
use trench_msgs::{Message, service_info, services, type_named, types};

#[test]
fn constants_and_defaults_are_those_of_the_text() {
    assert_eq!((Segment::KIND_LINE, Segment::KIND_GRAPH, LeaderState::LIMIT_STALE), (0_u8, 7_u8, 8_u8));
    assert_eq!((Marker::DELETEALL, Marker { r#type: Marker::CUBE, ..Default::default() }.r#type), (3_i32, 1));
    assert_eq!(ListParametersRequest::DEPTH_RECURSIVE, 0_u64);
    assert_eq!(Quaternion::default(), Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 });
}

#[test]
fn every_type_is_found_by_its_name() {
    for info in types() {
        assert_eq!(type_named(info.name), Some(*info));
        assert!(Schema::parse(info.name, info.definition).is_ok(), "{}", info.name);
    }
    assert_eq!(type_named("trench_msgs/msg/Nothing"), None);
    assert!(services().contains(&service_info::<Trigger>()));
}

#[test]
fn a_definition_carries_each_dependency_once() {
    let definition = PoseStamped::TYPE.definition;
    let line = "=".repeat(80);
    let parts: Vec<&str> = definition.split(&format!("{line}\n")).collect();
    assert!(parts[0].ends_with("std_msgs/Header header\nPose pose\n"), "{}", parts[0]);
    let mut names: Vec<&str> = parts[1..].iter().filter_map(|part| part.lines().next()).collect();
    names.sort_unstable();
    let expected = [
        "MSG: builtin_interfaces/Time",
        "MSG: geometry_msgs/Point",
        "MSG: geometry_msgs/Pose",
        "MSG: geometry_msgs/Quaternion",
        "MSG: std_msgs/Header",
    ];
    assert_eq!(names, expected);
}
