//! Worlds in lock-step: eight robots on a field of 4 m x 2.8 m, obstacles that only lasers see, obstacles that move.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[expect(dead_code, reason = "the experiments use the rest")]
mod support;
#[path = "support/team.rs"]
mod team;

use support::{Finished, drive_file};
use team::{formation, launch_file, places};
use trench_bag::run::{SummaryOptions, summary};
use trench_harness::Ending;

/// Two columns at the left edge.
const STARTS: &str = "[0.3, 0.4, 0.0, 0.3, 1.0, 0.0, 0.3, 1.6, 0.0, 0.3, 2.2, 0.0, \
                      0.7, 0.6, 3.0, 0.7, 1.2, 3.0, 0.7, 1.8, 3.0, 0.7, 2.4, 3.0]";

fn cross(seconds: f64, bed: &[(&str, &str)]) -> Finished {
    // Places up to the far corner, 0.2 m from the edges.
    let mut far = places(8, [3.8, 2.6], 3);
    far[0] = [3.8, 2.6];
    far[1] = [3.8, 0.2];
    go(&far, STARTS, seconds, bed)
}

/// As many robots as there are places go there on the large field.
fn go(places: &[[f64; 2]], starts: &str, seconds: f64, bed: &[(&str, &str)]) -> Finished {
    let folder = tempfile::tempdir().unwrap();
    let (formation_path, launch_path) = (folder.path().join("places.yaml"), folder.path().join("run.launch.yaml"));
    std::fs::write(&formation_path, formation(places)).unwrap();
    let text = launch_file(places.len(), seconds, &formation_path.display().to_string(), starts, "large", bed);
    std::fs::write(&launch_path, text).unwrap();
    drive_file(&launch_path, &[])
}

fn check_nobody_touched_or_got_lost(finished: &Finished) {
    assert_eq!(finished.run.contacts, []);
    // The operator's verdict comes too early on a short run.
    let complaints = finished.complaints.iter().filter(|line| !line.contains("/operator:"));
    assert_eq!(complaints.collect::<Vec<_>>(), Vec::<&String>::new());
}

#[test]
fn eight_robots_cross_a_large_field_below_one_camera() {
    let finished = cross(60.0, &[("camera", "overhead_large"), ("render", "false")]);
    assert_eq!(finished.ending, Ending::Exit { node: "/operator".to_owned(), code: 0 });
    check_nobody_touched_or_got_lost(&finished);
}

#[test]
fn twenty_robots_share_the_radio_the_map_and_their_lasers() {
    let start = |index: u8| {
        let (column, row) = (f64::from(index % 5), f64::from(index / 5));
        format!("{:?}, {:?}, {:?}", 0.4 + 0.8 * column, 0.35 + 0.7 * row, 0.3 * f64::from(index) - 3.0)
    };
    let starts = format!("[{}]", (0..20).map(start).collect::<Vec<_>>().join(", "));
    let lasers = format!("[{}]", (1..=20).map(|robot| format!("robot{robot}")).collect::<Vec<_>>().join(", "));
    let bed = [("camera", "overhead_four"), ("render", "false"), ("lasers", &lasers)];
    let finished = go(&places(20, [3.8, 2.6], 5), &starts, 15.0, &bed);
    check_nobody_touched_or_got_lost(&finished);
    // What lasers see of the other robots is no obstacle: everybody gets on.
    let summary = summary(&finished.run, &SummaryOptions::default());
    assert!(summary.robots.iter().filter(|robot| robot.max_speed > 0.1).count() >= 18, "{summary}");
}

#[test]
fn four_cameras_with_one_map_hand_robots_over() {
    let finished = cross(60.0, &[("camera", "overhead_four"), ("render", "false")]);
    assert_eq!(finished.ending, Ending::Exit { node: "/operator".to_owned(), code: 0 });
    check_nobody_touched_or_got_lost(&finished);
}

#[test]
fn robots_are_found_in_frames_of_four_cameras() {
    check_nobody_touched_or_got_lost(&cross(6.0, &[("camera", "overhead_four"), ("render", "true")]));
}

#[test]
fn robots_are_found_in_frames_of_the_large_camera() {
    check_nobody_touched_or_got_lost(&cross(6.0, &[("camera", "overhead_large"), ("render", "true")]));
}

/// Four robots of the square experiment among obstacles.
fn square(obstacles: &str, seconds: f64, bed: &[(&str, &str)]) -> Finished {
    let folder = tempfile::tempdir().unwrap();
    let (obstacle_path, launch_path) = (folder.path().join("field.yaml"), folder.path().join("run.launch.yaml"));
    std::fs::write(&obstacle_path, obstacles).unwrap();
    let obstacles = obstacle_path.display().to_string();
    let bed = [bed, &[("obstacles", &obstacles), ("render", "false")]].concat();
    let formation = support::root().join("config/formations/square.yaml").display().to_string();
    let poses = "[0.15, 0.25, 0.50, 0.95, 0.20, 0.40, 0.20, 1.60, -0.30, 0.90, 1.55, -0.80]";
    std::fs::write(&launch_path, launch_file(4, seconds, &formation, poses, "bed", &bed)).unwrap();
    drive_file(&launch_path, &[])
}

#[test]
fn obstacles_that_only_lasers_see_are_gone_round() {
    // One disc on the way of the near queue's points, one beside the far queue's segment.
    let discs = "obstacles:\n- {polygon: [[0.85, 0.47]], radius: 0.07}\n- {polygon: [[1.5, 1.45]], radius: 0.05}\n";
    let lasers = ("lasers", "[robot1, robot2, robot3, robot4]");
    let finished = square(discs, 60.0, &[lasers, ("publish_obstacles", "false")]);
    let summary = summary(&finished.run, &SummaryOptions::default());
    assert_eq!(summary.contacts, [], "{summary}");
    assert_eq!(finished.ending, Ending::Exit { node: "/operator".to_owned(), code: 0 }, "{summary}");
    // Blind robots do run into the one on their way.
    let blind = square(discs, 40.0, &[("publish_obstacles", "false")]);
    assert!(blind.run.contacts.iter().any(|contact| contact.thing == "obstacle 1"), "{:?}", blind.run.contacts);
}

#[test]
fn a_wall_that_runs_over_the_field_is_told_of() {
    // A wall as high as the field comes from the right, faster than robots are.
    let wall = "obstacles:\n- {polygon: [[2.3, 0.0], [2.4, 0.0], [2.4, 1.83], [2.3, 1.83]], velocity: [-0.5, 0.0]}\n";
    let finished = square(wall, 4.0, &[]);
    let text = summary(&finished.run, &SummaryOptions::default()).to_string();
    assert!(text.contains("touched obstacle 1 at ("), "{text}");
}
