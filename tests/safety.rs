//! Random teams through the whole stack in lock-step: the safety filter behind the laws, on the honest bed.
//!
//! Robots start anywhere and are sent straight to places anywhere, one queue a place, so that ways cross. Ground truth
//! judges: no two bodies ever touch, and everybody arrives (a filter that stands still for ever fails too).
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[expect(dead_code, reason = "the experiments use the rest")]
mod support;

use trench_bag::run::Run;

use std::fmt::Write;
use support::{drive_file, random_poses, root};
use trench_bag::run::{SummaryOptions, summary};
use trench_harness::Ending;
use trench_sim::Random;

/// Places at least this far from each other, m: bodies of 0.16 m and room to pass.
const APART: f64 = 0.36;

fn places(count: usize, seed: u64) -> Vec<[f64; 2]> {
    let mut random = Random::new(seed, 97);
    let mut places: Vec<[f64; 2]> = Vec::new();
    while places.len() < count {
        let place = [random.between(0.25, 2.2), random.between(0.25, 1.55)];
        if places.iter().all(|other| libm::hypot(place[0] - other[0], place[1] - other[1]) > APART) {
            places.push(place);
        }
    }
    places
}

fn formation(places: &[[f64; 2]]) -> String {
    let mut text = "name: anywhere\nframe: map\nqueues:\n".to_owned();
    for (index, [x, y]) in places.iter().enumerate() {
        let share = 1.0 / places.len() as f64;
        let end = y + 0.1;
        write!(
            text,
            "- name: place{index}\n  segment: {{kind: line, points: [[{x}, {y}], [{x}, {end}]]}}\n  \
             vertices: [[{x}, {y}]]\n  share: {share}\n  tolerance: 0.02\n"
        )
        .unwrap();
    }
    text
}

fn launch_file(robots: usize, formation: &str, poses: &str) -> String {
    let launch = root().join("launch");
    let names: Vec<String> = (1..=robots).map(|robot| format!("robot{robot}")).collect();
    let team = format!("[{}]", names.join(", "));
    let mut text = format!(
        "launch:\n\
         - include:\n    file: \"{bed}\"\n    arg:\n    - {{name: robots, value: \"{team}\"}}\n    \
         - {{name: poses, value: \"{poses}\"}}\n    - {{name: render, value: \"false\"}}\n\
         - node:\n    exec: leader_assignment\n    name: leader_assignment\n    param:\n    \
         - {{name: robots, value: {team}}}\n    - {{name: formation_file, value: \"{formation}\"}}\n\
         - node:\n    exec: operator\n    name: operator\n    param:\n    - {{name: robots, value: {team}}}\n    \
         - {{name: duration, value: 60.0}}\n",
        bed = launch.join("bed.launch.yaml").display(),
    );
    for name in names {
        write!(
            text,
            "- include:\n    file: \"{controller}\"\n    arg:\n    - {{name: robot, value: \"{name}\"}}\n    \
             - {{name: robots, value: \"{team}\"}}\n",
            controller = launch.join("controller.launch.yaml").display(),
        )
        .unwrap();
    }
    text
}

#[test]
fn random_teams_arrive_without_contact() {
    let (mut runs, mut arrived, mut closest) = (0, 0, f64::INFINITY);
    let seeds = std::env::var("TRENCH_SEEDS").ok().and_then(|text| text.parse().ok()).unwrap_or(10_u64);
    for robots in 2..=6 {
        for seed in 1..=seeds {
            let folder = tempfile::tempdir().unwrap();
            let (formation_path, launch_path) =
                (folder.path().join("places.yaml"), folder.path().join("run.launch.yaml"));
            std::fs::write(&formation_path, formation(&places(robots, seed))).unwrap();
            let poses = random_poses(robots, 1000 + seed);
            let text = launch_file(robots, &formation_path.display().to_string(), &poses);
            std::fs::write(&launch_path, text).unwrap();
            let finished = drive_file(&launch_path, &[]);
            let summary = summary(&finished.run, &SummaryOptions::default());
            let gap = summary.closest.as_ref().unwrap().gap;
            assert!(gap > 0.0, "{robots} robots, seed {seed}: {:?}", summary.closest);
            closest = closest.min(gap);
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
        assert!(gap > 0.0, "a robot came {gap} m near the disc at {centre:?}");
        println!("disc at {centre:?}: {gap:.3} m");
    }
    let summary = summary(&finished.run, &SummaryOptions::default());
    assert!(summary.closest.as_ref().unwrap().gap > 0.0);
    assert_eq!(finished.ending, Ending::Exit { node: "/operator".to_owned(), code: 0 }, "{summary}");
}
