//! Random teams through the whole stack in lock-step: the safety filter behind the laws, on the honest bed.
//!
//! Robots start anywhere and are sent straight to places anywhere, one queue a place, so that ways cross. Ground truth
//! judges: no two bodies ever touch, and everybody arrives (a filter that stands still for ever fails too).
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[expect(dead_code, reason = "the experiments use the rest")]
mod support;
#[path = "support/team.rs"]
mod team;

use trench_bag::run::Run;

use support::{drive_file, random_poses, root};
use team::{formation, launch_file, places};
use trench_bag::run::{SummaryOptions, summary};
use trench_harness::Ending;

#[test]
fn random_teams_arrive_without_contact() {
    let (mut runs, mut arrived, mut closest) = (0, 0, f64::INFINITY);
    let seeds = std::env::var("TRENCH_SEEDS").ok().and_then(|text| text.parse().ok()).unwrap_or(10_u64);
    for robots in 2..=6 {
        for seed in 1..=seeds {
            let folder = tempfile::tempdir().unwrap();
            let (formation_path, launch_path) =
                (folder.path().join("places.yaml"), folder.path().join("run.launch.yaml"));
            std::fs::write(&formation_path, formation(&places(robots, [2.2, 1.55], seed))).unwrap();
            let poses = random_poses(robots, 1000 + seed);
            let text =
                launch_file(robots, 60.0, &formation_path.display().to_string(), &poses, "bed", &[("render", "false")]);
            std::fs::write(&launch_path, text).unwrap();
            let finished = drive_file(&launch_path, &[]);
            let summary = summary(&finished.run, &SummaryOptions::default());
            assert_eq!(summary.contacts, [], "{robots} robots, seed {seed}");
            closest = closest.min(summary.closest.as_ref().unwrap().gap);
            runs += 1;
            let formed = finished.ending == Ending::Exit { node: "/operator".to_owned(), code: 0 };
            arrived += i32::from(formed);
            if !formed {
                println!("{robots} robots, seed {seed}: not all within 2 cm after 60 s\n{summary}");
            }
        }
    }
    println!("{arrived} of {runs} teams arrived, the least gap between bodies was {closest:.4} m");
    assert!(f64::from(arrived) >= 0.98 * f64::from(runs), "{arrived} of {runs}");
}

/// The least distance (m) between the bodies of a run and a disc at rest.
fn clearance(run: &Run, centre: [f64; 2], radius: f64) -> f64 {
    let poses = run.robots.values().flat_map(|track| &track.poses);
    let gap = |x: f64, y: f64| libm::hypot(x - centre[0], y - centre[1]) - radius - 0.08;
    poses.map(|pose| gap(pose.x, pose.y)).fold(f64::INFINITY, f64::min)
}

#[test]
fn obstacles_on_the_way_are_gone_round() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("field.yaml");
    // One disc on the way of the near queue's points, one beside the far queue's segment.
    let discs = [([0.85, 0.47], 0.07), ([1.5, 1.45], 0.05)];
    let entry = |(centre, radius): &([f64; 2], f64)| format!("- {{polygon: [{centre:?}], radius: {radius}}}\n");
    std::fs::write(&path, format!("obstacles:\n{}", discs.iter().map(entry).collect::<String>())).unwrap();
    let launch = root().join("launch/square.launch.yaml");
    let obstacles = path.display().to_string();
    let finished = drive_file(&launch, &[("obstacles", &obstacles), ("duration", "60.0")]);
    for (centre, radius) in discs {
        let gap = clearance(&finished.run, centre, radius);
        println!("disc at {centre:?}: {gap:.3} m");
    }
    let summary = summary(&finished.run, &SummaryOptions::default());
    assert_eq!(summary.contacts, [], "{summary}");
    assert_eq!(finished.ending, Ending::Exit { node: "/operator".to_owned(), code: 0 }, "{summary}");
}
