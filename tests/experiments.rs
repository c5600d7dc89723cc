//! The two experiments of 4.6 in lock-step: profile `tuned` on the honest bed, profile `thesis` on the ideal one.
//!
//! `TRENCH_SEEDS` sets how many random starts each takes (20 in scripts/acceptance).
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[expect(dead_code, reason = "the pursuits use the rest")]
mod support;

use support::{Finished, drive, random_poses};
use trench_bag::run::{RunSummary, SummaryOptions, summary};
use trench_harness::Ending;

/// Robots of the triangle and of the square, and when their points stop.
const EXPERIMENTS: [(&str, usize); 2] = [("triangle.launch.yaml", 3), ("square.launch.yaml", 4)];

fn seeds() -> u64 {
    std::env::var("TRENCH_SEEDS").ok().and_then(|text| text.parse().ok()).unwrap_or(20)
}

fn judged(finished: &Finished, shape_times: &[f64]) -> RunSummary {
    let options = SummaryOptions { shape_times: shape_times.to_vec(), ..SummaryOptions::default() };
    let summary = summary(&finished.run, &options);
    assert!(summary.ground_truth, "judged by ground truth, not by what the vision believes");
    summary
}

fn no_contact(summary: &RunSummary, what: &str) {
    let closest = summary.closest.as_ref().unwrap();
    assert!(closest.gap > 0.0, "{what}: {closest:?}");
}

/// Final distances to the vertices, in metres.
fn final_distances(summary: &RunSummary) -> Vec<f64> {
    summary.robots.iter().map(|robot| robot.final_distance.unwrap()).collect()
}

#[test]
fn the_tuned_profile_forms_within_two_centimetres_from_anywhere() {
    let (mut worst_distance, mut worst_shape) = (0.0_f64, 0.0_f64);
    for (file, robots) in EXPERIMENTS {
        for seed in 1..=seeds() {
            let what = format!("{file}, seed {seed}");
            let poses = random_poses(robots, seed);
            let seed = seed.to_string();
            let finished = drive(file, &[("poses", &poses), ("seed", &seed), ("duration", "40.0")]);
            assert_eq!(finished.ending, Ending::Exit { node: "/operator".to_owned(), code: 0 }, "{what}");
            let summary = judged(&finished, &[]);
            no_contact(&summary, &what);
            for distance in final_distances(&summary) {
                assert!(distance <= 0.02, "{what}: {distance} m from the vertex");
                worst_distance = worst_distance.max(distance);
            }
            // The default interval: the last third of the points' motion, and at rest.
            let shape = summary.max_shape_error.unwrap();
            assert!(shape <= 0.02, "{what}: shape error {shape} m\n{summary}");
            worst_shape = worst_shape.max(shape);
        }
    }
    println!("worst final distance {worst_distance:.4} m, worst shape error {worst_shape:.4} m");
}

#[test]
fn the_thesis_profile_ends_where_the_thesis_s_robots_did() {
    for (file, robots) in EXPERIMENTS {
        for seed in 1..=seeds() {
            let what = format!("{file}, seed {seed}");
            let start = if seed == 1 { None } else { Some(near_the_printed_start(file, robots, seed)) };
            let seed = seed.to_string();
            let mut arguments = vec![
                ("profile", "thesis"),
                ("bed", "ideal"),
                ("seed", seed.as_str()),
                ("duration", "60.0"),
                ("tolerance", "0.2"),
            ];
            arguments.extend(start.as_deref().map(|poses| ("poses", poses)));
            let summary = judged(&drive(file, &arguments), &[24.0, 60.0]);
            no_contact(&summary, &what);
            for distance in final_distances(&summary) {
                assert!((0.12..=0.165).contains(&distance), "{what}: {distance} m from the vertex");
            }
            let shape = |index: usize| summary.shape[index].error;
            if file.starts_with("triangle") {
                assert!(shape(0) < 0.12, "{what}: {} m at 24 s", shape(0));
            }
            assert!(shape(1) < 0.06, "{what}: {} m at 60 s", shape(1));
        }
    }
}

/// The printed starts, shifted and turned a little: the reference ranges are those of the printed ones under noise.
fn near_the_printed_start(file: &str, robots: usize, seed: u64) -> String {
    let printed: &[f64] = if file.starts_with("triangle") {
        &[0.75, 1.20, -0.60, 0.20, 0.20, 0.80, 0.25, 1.60, -0.50]
    } else {
        &[0.15, 0.25, 0.50, 0.95, 0.20, 0.40, 0.20, 1.60, -0.30, 0.90, 1.55, -0.80]
    };
    assert_eq!(printed.len(), 3 * robots);
    let mut random = trench_sim::Random::new(seed, 98);
    let numbers: Vec<String> =
        printed.iter().map(|number| format!("{:?}", number + random.between(-0.02, 0.02))).collect();
    format!("[{}]", numbers.join(", "))
}

#[test]
fn two_runs_are_equal_byte_for_byte() {
    let arguments = [("duration", "8.0"), ("tolerance", "1.0")];
    let (first, second) = (drive("square.launch.yaml", &arguments), drive("square.launch.yaml", &arguments));
    assert_eq!(first.digest, second.digest);
    let other = drive("square.launch.yaml", &[("duration", "8.0"), ("tolerance", "1.0"), ("seed", "2")]);
    assert_ne!(first.digest, other.digest, "another seed is another run");
}

#[test]
fn rendered_frames_lead_to_the_same_formation() {
    let arguments = [("render", "true"), ("duration", "16.0")];
    let finished = drive("square.launch.yaml", &arguments);
    assert_eq!(finished.ending, Ending::Exit { node: "/operator".to_owned(), code: 0 }, "{:?}", finished.complaints);
    let summary = judged(&finished, &[]);
    no_contact(&summary, "rendered");
    assert!(final_distances(&summary).iter().all(|distance| *distance <= 0.02), "{summary}");
}
