//! What the nodes and `trench view --markers` draw for RViz2 and Foxglove.

use crate::support::{Island, Launch, Running, markers};
use std::collections::BTreeSet;
use std::time::{Duration, Instant};

/// Robots come to obstacles long before.
const A_PURSUIT: Duration = Duration::from_secs(120);
/// What raises an alarm for certain.
const FAULTS: &str = "faults:\n- {kind: battery, from: 0.0, to: 600.0, robots: [robot3], volts: 6.0}\n";

/// All that the figures of chapter 7 show, of every node that draws, comes and is what RViz takes without complaint.
#[test]
fn interop_markers_are_what_rviz_draws() {
    let island = Island::new(0);
    let folder = tempfile::tempdir().unwrap();
    let faults = folder.path().join("faults.yaml");
    std::fs::write(&faults, FAULTS).unwrap();
    let faults = format!("faults:={}", faults.display());
    let arguments = ["render:=false", "depart:=0.0", "duration:=600.0", &faults];
    let launch = Launch::start(&island, "launch/pursuit.launch.yaml", &arguments);
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
    let start = Instant::now();
    while !missing.is_empty() && start.elapsed() < A_PURSUIT {
        let array = drawn.next();
        assert_eq!(markers::problems(&array), [""; 0]);
        for marker in array["markers"].as_array().unwrap() {
            missing.remove(marker["ns"].as_str().unwrap());
        }
    }
    assert_eq!(missing, BTreeSet::new(), "not drawn");
    drop(viewer);
    let (code, said) = launch.interrupt();
    assert_eq!(code, Some(130), "the run is not over: {said}");
}
