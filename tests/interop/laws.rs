//! The law of a running controller, changed by a real ROS 2 client.

use crate::support::{Island, Launch, number};
use serde_json::{Value, json};

/// How far the point that a robot steers is from its axle, m.
fn look_ahead(state: &Value) -> f64 {
    let apart = |axis: &str| number(state, &format!("/point/{axis}")) - number(state, &format!("/position/{axis}"));
    libm::hypot(apart("x"), apart("y"))
}

/// A follower in a column that drives by (7.13) is told to go to its goal point by (3.13), and back; what no law is changes nothing.
#[test]
fn interop_rclpy_changes_the_law_of_a_running_column() {
    let island = Island::new(3);
    let launch = Launch::start(&island, "launch/column.launch.yaml", &["render:=false", "duration:=600.0"]);
    let assignment = island.latched("/assignment trench_msgs/msg/Assignment");
    let members = assignment["members"].as_array().unwrap();
    let robot = members.iter().find(|member| member["rank"] == 3).unwrap()["robot"].as_str().unwrap();
    let set = |value: &str| island.ask("peer_param.py", &format!("/{robot}/formation_controller set law {value}"));
    let monitor = island.follow(&format!("/{robot}/stability trench_msgs/msg/Stability --qos reliable,volatile,10"));
    let drives_by = |law: &str, equation: &str| {
        let said = monitor.until(law, |said| said["law"] == law && said["equation"] == equation);
        assert_eq!(said["robot"], robot, "{said}");
    };
    drives_by("chain", "(7.13)");
    let refused = set("\"pure_pursuit\"");
    assert_eq!(refused["successful"], false, "{refused}");
    assert!(refused["reason"].as_str().unwrap().contains("law"), "{refused}");
    drives_by("chain", "(7.13)");
    let states = format!("/{robot}/leader_state trench_msgs/msg/LeaderState --qos reliable,volatile,10");
    let states = island.follow(&states);
    let ahead = look_ahead(&states.next());
    assert!((ahead - 0.035).abs() < 1e-6, "(7.13) steers a point in front of the axle: {ahead}");
    assert_eq!(set("\"robust\"")["successful"], true);
    let value = island.ask("peer_param.py", &format!("/{robot}/formation_controller get law"));
    assert_eq!(value["value"], json!("robust"));
    drives_by("robust", "(3.13)");

    // It goes on with the others, to its goal point, and steers its axle.
    let moves = |state: &Value| libm::hypot(number(state, "/velocity/x"), number(state, "/velocity/y")) > 0.03;
    states.until("it goes with its goal point", |state| number(state, "/goal_distance") < 0.03 && moves(state));
    let now = &states.during(0.5)[0];
    assert!(look_ahead(now) < 1e-6 && number(now, "/goal_distance") < 0.05, "{now}");

    assert_eq!(set("\"chain\"")["successful"], true);
    drives_by("chain", "(7.13)");
    let (code, said) = launch.interrupt();
    assert_eq!(code, Some(130), "{said}");
}
