//! Random teams through the whole stack in lock-step: the safety filter behind the laws, on the honest bed.
//!
//! Robots start anywhere and are sent straight to places anywhere, one queue a place, so that ways cross. Ground truth
//! judges: no two bodies ever touch, and everybody arrives (a filter that stands still for ever fails too).
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[expect(dead_code, reason = "the experiments use the rest")]
mod support;
#[path = "support/team.rs"]
mod team;

use support::{Finished, drive_file, named_seeds, random_poses, root};
use team::{formation, launch_file, places};
use trench_bag::run::{Pose, Run, SummaryOptions, summary};
use trench_harness::Ending;
use trench_sim::Random;

fn seeds() -> u64 {
    named_seeds().unwrap_or(10)
}

/// A random team crosses the bed, with these `faults` if there are any.
fn cross(robots: usize, seed: u64, seconds: f64, faults: &str) -> Finished {
    let folder = tempfile::tempdir().unwrap();
    let [formation_path, launch_path, faults_path] =
        ["places.yaml", "run.launch.yaml", "faults.yaml"].map(|name| folder.path().join(name));
    std::fs::write(&formation_path, formation(&places(robots, [2.2, 1.55], seed))).unwrap();
    std::fs::write(&faults_path, format!("faults:\n{faults}")).unwrap();
    let (poses, faults_file) = (random_poses(robots, 1000 + seed), faults_path.display().to_string());
    let mut bed = vec![("render", "false")];
    if !faults.is_empty() {
        bed.push(("faults", &faults_file));
    }
    let text = launch_file(robots, seconds, &formation_path.display().to_string(), &poses, "bed", &bed);
    std::fs::write(&launch_path, text).unwrap();
    drive_file(&launch_path, &[])
}

/// How far (m, between bodies) before another robot one is put down: that robot is under way, and this is more than it needs to
/// stop.
const ROOM: f64 = 0.2;

/// A robot of the run that is put down in the way of another in full motion, as a line of a fault file; none where there is no place.
fn into_the_way(run: &Run, seed: u64) -> Option<String> {
    let mut random = Random::new(seed, 95);
    // The bed's time begins a second after the steady clock's, whose zero is that of ROS time's epoch in lock-step.
    let bed_began = 1_577_836_801.0;
    for _ in 0..200 {
        let time = random.between(1.0, 8.0);
        let poses: Vec<_> = run.robots.iter().filter_map(|(name, track)| Some((name, track.pose_at(time)?))).collect();
        let mut pick = || ((random.unit() * poses.len() as f64) as usize).min(poses.len() - 1);
        let (mover, carried) = (pick(), pick());
        let (_, pose) = poses[mover];
        if mover == carried || pose.v < 0.15 {
            continue;
        }
        let away = 0.16 + ROOM;
        let spot = [pose.x + away * libm::cos(pose.theta), pose.y + away * libm::sin(pose.theta)];
        let clear = |(index, (_, other)): (usize, &(&String, Pose))| {
            index == carried || libm::hypot(other.x - spot[0], other.y - spot[1]) > away - 1e-9
        };
        let on_the_bed = (0.15..2.33).contains(&spot[0]) && (0.15..1.68).contains(&spot[1]);
        if on_the_bed && poses.iter().enumerate().all(clear) {
            let from = run.t0? as f64 * 1e-9 - bed_began + time;
            let ([x, y], robot) = (spot, poses[carried].0);
            let heading = random.between(-3.1, 3.1);
            let (to, pose) = (from + 0.1, format!("[{x:.4}, {y:.4}, {heading:.4}]"));
            return Some(format!("- {{kind: carried, robot: {robot}, from: {from:.3}, to: {to:.3}, pose: {pose}}}\n"));
        }
    }
    None
}

#[test]
fn a_robot_that_is_carried_into_another_s_way_is_touched_by_nobody() {
    let (mut runs, mut arrived) = (0, 0);
    for robots in 2..=6 {
        for seed in 1..=seeds() {
            // As it goes without hands in the game, up to when they come in.
            let undisturbed = cross(robots, seed, 9.0, "");
            let Some(fault) = into_the_way(&undisturbed.run, seed) else { continue };
            let finished = cross(robots, seed, 75.0, &fault);
            let summary = summary(&finished.run, &SummaryOptions::default());
            assert_eq!(summary.contacts, [], "{robots} robots, seed {seed}: {fault}{summary}");
            runs += 1;
            arrived += u64::from(finished.ending == Ending::Exit { node: "/operator".to_owned(), code: 0 });
        }
    }
    println!("{arrived} of {runs} teams with a robot carried arrived");
    assert!(runs >= 3 * seeds(), "{runs} runs alone");
    assert!(arrived as f64 >= 0.95 * runs as f64, "{arrived} of {runs}");
}

#[test]
fn random_teams_arrive_without_contact() {
    let (mut runs, mut arrived, mut closest) = (0, 0, f64::INFINITY);
    let seeds = seeds();
    for robots in 2..=6 {
        for seed in 1..=seeds {
            let finished = cross(robots, seed, 60.0, "");
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
