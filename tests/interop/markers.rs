//! What the nodes and `trench view --markers` draw for RViz2 and Foxglove.

use crate::support::{Island, Launch, Running, markers};
use std::collections::BTreeSet;

/// All that the figures of chapter 7 show, of every node that draws, comes and is what RViz takes without complaint.
#[test]
fn interop_markers_are_what_rviz_draws() {
    let island = Island::new(0);
    let launch = Launch::start(&island, "launch/pursuit.launch.yaml", &["render:=false", "duration:=600.0"]);
    let mut viewer = island.command(env!("CARGO_BIN_EXE_trench"));
    let viewer = Running::start(viewer.args(["view", "--markers", "--port", "0"]).stdout(std::process::Stdio::null()));
    let drawn = island.follow("/markers visualization_msgs/msg/MarkerArray --qos reliable,volatile,100");
    let mut missing = BTreeSet::from([
        "apparent_obstacles",
        "apparent_obstacles/members",
        "controller/encroached",
        "controller/forces",
        "controller/fragments",
        "controller/hulls",
        "controller/nearest",
        "controller/sectors",
        "controller/zones",
        "formation/goals",
        "formation/leaders",
        "formation/segments",
        "formation/vertices",
        "robots/body",
        "robots/heading",
        "robots/name",
        "view/alarms",
        "view/links",
        "view/stability",
        "view/trails",
    ]);
    drawn.until("all is drawn", |array| {
        assert_eq!(markers::problems(array), [""; 0]);
        for marker in array["markers"].as_array().unwrap() {
            missing.remove(marker["ns"].as_str().unwrap());
        }
        missing.is_empty()
    });
    drop(viewer);
    let (code, said) = launch.interrupt();
    assert_eq!(code, Some(130), "the run is not over: {said}");
}
