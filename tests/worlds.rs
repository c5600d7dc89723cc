//! Worlds larger than the lab's bed, in lock-step: eight robots cross a field of 4 m x 2.8 m.
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
    let folder = tempfile::tempdir().unwrap();
    let (formation_path, launch_path) = (folder.path().join("places.yaml"), folder.path().join("run.launch.yaml"));
    // Places up to the far corner, 0.2 m from the edges.
    let mut far = places(8, [3.8, 2.6], 3);
    far[0] = [3.8, 2.6];
    far[1] = [3.8, 0.2];
    std::fs::write(&formation_path, formation(&far)).unwrap();
    let text = launch_file(8, seconds, &formation_path.display().to_string(), STARTS, "large", bed);
    std::fs::write(&launch_path, text).unwrap();
    drive_file(&launch_path, &[])
}

fn check_nobody_touched_or_got_lost(finished: &Finished) {
    assert!(summary(&finished.run, &SummaryOptions::default()).closest.unwrap().gap > 0.0);
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
fn robots_are_found_in_frames_of_the_large_camera() {
    check_nobody_touched_or_got_lost(&cross(6.0, &[("camera", "overhead_large"), ("render", "true")]));
}
