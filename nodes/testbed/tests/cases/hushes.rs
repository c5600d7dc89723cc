//! The test bed's word on obstacles and lasers: when it comes, and that it stays away where a fault says so.

use crate::common::{EPOCH, Loop, Node, Texts, strings};
use trench_config::ParameterValue::{Bool, String as Text};
use trench_core::RosTime;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::{DiscArray, ObstacleArray};
use trench_msgs::sensor_msgs::LaserScan;

const DISC: &str = "obstacles:\n- {polygon: [[1.5, 0.9]], radius: 0.1}\n";
const NONE: &str = "obstacles: []\n";
const HUSHES: &str =
    "faults:\n- {kind: untold, from: 1.0, to: 2.0}\n- {kind: blind, from: 1.5, to: 2.5, robots: [robot2]}\n";

fn bed(obstacles: &'static str, publishes: bool) -> Loop {
    let given = [
        ("obstacles_file", Text("obstacles".to_owned())),
        ("publish_obstacles", Bool(publishes)),
        ("faults_file", Text("faults".to_owned())),
        ("laser.robots", strings(&["robot1", "robot2"])),
    ];
    let files = Texts(vec![("obstacles", obstacles), ("faults", HUSHES)]);
    Loop::new(&[0.4, 0.5, 0.0, 0.4, 1.2, 0.0], &[], &given, &files)
}

/// Stamps, ms after the start.
fn stamps(headers: impl Iterator<Item = trench_msgs::std_msgs::Header>) -> Vec<i64> {
    headers.map(|header| (RosTime::from(&header.stamp).0 - EPOCH) / 1_000_000 - 1000).collect()
}

/// The longest time from one to the next, ms, and when it began.
fn longest(stamps: &[i64]) -> (i64, i64) {
    stamps.windows(2).map(|pair| (pair[1] - pair[0], pair[0])).max().unwrap_or_default()
}

#[test]
fn obstacles_are_told_of_with_each_frame_but_for_a_time() {
    for obstacles in [DISC, NONE] {
        let mut both = bed(obstacles, true);
        both.run(4000);
        let told: Vec<ObstacleArray> = both.testbed.published("/obstacles");
        let silence = longest(&stamps(told.into_iter().map(|message| message.header)));
        assert!((1000..=1070).contains(&silence.0) && (900..1000).contains(&silence.1), "{silence:?}");
        let frames: Vec<DiscArray> = both.testbed.published("/overhead/detections");
        let between = longest(&stamps(frames.into_iter().map(|message| message.header)));
        assert!(between.0 <= 34, "the camera goes on: {between:?}");
    }
    let untold = bed(DISC, false);
    let publishes = |node: &Node| node.core.interface().publications.iter().any(|topic| topic.topic == "/obstacles");
    assert!(!publishes(&untold.testbed));
}

#[test]
fn a_robot_s_laser_is_silent_for_a_time_and_it_is_said() {
    let mut both = bed(DISC, true);
    both.run(4000);
    let silence = |robot: &str| {
        let scans: Vec<LaserScan> = both.testbed.published(&format!("/{robot}/scan"));
        longest(&stamps(scans.into_iter().map(|scan| scan.header))).0
    };
    assert!((1000..=1100).contains(&silence("robot2")) && silence("robot1") <= 100);
    let said: Vec<DiagnosticArray> = both.testbed.published("/diagnostics");
    let faults = said.iter().flat_map(|array| &array.status).filter(|status| status.name.ends_with(": faults"));
    let mut texts: Vec<&str> = faults.map(|status| status.message.as_str()).collect();
    texts.dedup();
    assert_eq!(texts, ["untold", "untold, blind", "blind", "none"]);
}
