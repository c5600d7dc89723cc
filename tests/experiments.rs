//! The two experiments of 4.6 in lock-step: profile `tuned` on the honest bed, profile `thesis` on the ideal one.
//!
//! `TRENCH_SEEDS` sets how many random starts each takes (20 in scripts/acceptance).
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[expect(dead_code, reason = "the pursuits use the rest")]
mod support;

use std::fmt::{self, Display};
use support::{Finished, drive, named_seeds, random_poses};
use trench_bag::run::{Run, RunSummary, SummaryOptions, Track, distance, summary};
use trench_harness::Ending;

/// Robots of the triangle and of the square, and when their points stop.
const EXPERIMENTS: [(&str, usize); 2] = [("triangle.launch.yaml", 3), ("square.launch.yaml", 4)];

fn seeds() -> u64 {
    named_seeds().unwrap_or(20)
}

fn judged(finished: &Finished, shape_times: &[f64]) -> RunSummary {
    let options = SummaryOptions { shape_times: shape_times.to_vec(), ..SummaryOptions::default() };
    let summary = summary(&finished.run, &options);
    assert!(summary.ground_truth, "judged by ground truth, not by what the vision believes");
    summary
}

/// By what the bed tells of bodies that touched: it lets none into another, so that the gap between them is no judge.
fn no_contact(summary: &RunSummary, what: &str) {
    assert_eq!(summary.contacts, [], "{what}: {summary}");
}

/// Final distances to the vertices, in metres.
fn final_distances(summary: &RunSummary) -> Vec<f64> {
    summary.robots.iter().map(|robot| robot.final_distance.unwrap()).collect()
}

/// The worst of several runs, m.
#[derive(Default)]
struct Worst {
    distance: f64,
    shape: f64,
}

impl Worst {
    /// A run with the tuned profile from anywhere, on the bed's motors, delays and losses and with the noise of 4.5.3, as
    /// the thesis profile has it.
    fn tuned(&mut self, (file, robots): (&str, usize), seed: u64, render: bool) {
        let what = format!("{file}, seed {seed}, render {render}");
        let (poses, seed, render) = (random_poses(robots, seed), seed.to_string(), render.to_string());
        let own = [("poses", poses.as_str()), ("seed", &seed), ("render", &render)];
        let finished = drive(file, &[&own[..], &[("noise", "thesis"), ("duration", "40.0")]].concat());
        let summary = judged(&finished, &[]);
        no_contact(&summary, &what);
        for distance in final_distances(&summary) {
            assert!(distance <= 0.02, "{what}: {distance} m from the vertex");
            self.distance = self.distance.max(distance);
        }
        // The default interval: the last third of the points' motion, and at rest.
        let shape = summary.max_shape_error.unwrap();
        assert!(shape <= 0.02, "{what}: shape error {shape} m\n{summary}");
        self.shape = self.shape.max(shape);
        let end = Ending::Exit { node: "/operator".to_owned(), code: 0 };
        assert_eq!(finished.ending, end, "{what}: {:?}", finished.complaints);
    }
}

impl Display for Worst {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "worst final distance {:.4} m, worst shape error {:.4} m", self.distance, self.shape)
    }
}

#[test]
fn the_tuned_profile_forms_within_two_centimetres_from_anywhere() {
    let mut worst = Worst::default();
    for experiment in EXPERIMENTS {
        (1..=seeds()).for_each(|seed| worst.tuned(experiment, seed, false));
    }
    println!("{worst}");
}

#[test]
fn the_tuned_profile_forms_from_rendered_frames() {
    let mut worst = Worst::default();
    for experiment in EXPERIMENTS {
        (1..=seeds().div_ceil(5)).for_each(|seed| worst.tuned(experiment, 100 + seed, true));
    }
    println!("{worst} from rendered frames");
}

#[test]
fn the_tuned_profile_forms_from_sixty_frames_a_second() {
    for (file, _) in EXPERIMENTS {
        let finished = drive(file, &[("bed", "fast"), ("render", "true"), ("duration", "40.0")]);
        let summary = judged(&finished, &[]);
        no_contact(&summary, file);
        assert!(final_distances(&summary).iter().all(|distance| *distance <= 0.02), "{file}: {summary}");
        assert!(summary.max_shape_error.unwrap() <= 0.02, "{file}: {summary}");
        for (name, track) in &finished.run.robots {
            let (first, last) = (track.goals.first().unwrap().time, track.goals.last().unwrap().time);
            let ticks = (track.goals.len() - 1) as f64 / (last - first);
            assert!((59.0..=61.0).contains(&ticks), "{file}: {ticks} ticks a second for {name}");
        }
    }
}

/// What steppers miss where the radio loses nothing would be the controllers' fault: after a lost frame a command comes late, and
/// after several the robot stops by itself, which no ramp helps against.
#[test]
fn the_tuned_profile_s_ramps_are_followed() {
    for (file, robots) in EXPERIMENTS {
        for seed in 1..=seeds() {
            let (poses, text) = (random_poses(robots, seed), seed.to_string());
            let own = [("poses", poses.as_str()), ("seed", &text), ("bed", "lossless")];
            let finished = drive(file, &[&own[..], &[("noise", "thesis"), ("duration", "40.0")]].concat());
            assert_eq!(finished.missed_steps, [], "{file}, seed {seed}");
        }
    }
}

/// How far each robot is from its goal point when the last of these comes to rest, m.
fn lags(run: &Run, at: f64) -> Vec<f64> {
    let lag = |track: &Track| distance(track.pose_at(at).unwrap().position(), track.goal_at(at).unwrap());
    run.robots.values().map(lag).collect()
}

/// The reference ranges for the thesis profile, which are those of the printed starts under noise.
#[test]
fn the_thesis_profile_ends_where_the_thesis_s_robots_did() {
    let mut furthest = [f64::INFINITY, 0.0];
    for (file, robots) in EXPERIMENTS {
        // The last snapshots: Figures 4.36 and 4.42.
        let snapshot = if file.starts_with("triangle") { 24.0 } else { 20.0 };
        for seed in 1..=seeds() {
            let nearby = near_the_printed_start(file, robots, seed);
            for start in [None, Some(("poses", nearby.as_str()))] {
                let (what, seed) = (format!("{file}, seed {seed}, start {start:?}"), seed.to_string());
                let own = [("profile", "thesis"), ("bed", "ideal"), ("seed", &seed), ("duration", "60.0")];
                let finished = drive(file, &[&own[..], &[("tolerance", "0.2")], start.as_slice()].concat());
                let summary = judged(&finished, &[snapshot, 60.0]);
                no_contact(&summary, &what);
                for distance in final_distances(&summary) {
                    assert!((0.12..=0.165).contains(&distance), "{what}: {distance} m from the vertex");
                }
                let shape = |index: usize| summary.shape[index].error;
                assert!(shape(0) < 0.12, "{what}: {} m at {snapshot} s", shape(0));
                assert!(shape(1) < 0.06, "{what}: {} m at 60 s", shape(1));
                if start.is_none() {
                    for lag in lags(&finished.run, summary.motion.unwrap().1) {
                        // To the two digits that are given.
                        assert!((0.525..0.605).contains(&lag), "{what}: {lag} m behind when the points stop");
                        furthest = [furthest[0].min(lag), furthest[1].max(lag)];
                    }
                }
            }
        }
    }
    println!("worst lags when the points stop {:.3} and {:.3} m", furthest[0], furthest[1]);
}

#[test]
fn the_thesis_profile_keeps_robots_apart_on_the_honest_bed_from_anywhere() {
    let mut worst = 0.0_f64;
    for (file, robots) in EXPERIMENTS {
        for seed in 1..=seeds() {
            let what = format!("{file}, seed {seed}");
            let poses = random_poses(robots, seed);
            let seed = seed.to_string();
            let arguments = [("profile", "thesis"), ("poses", &poses), ("seed", &seed), ("duration", "60.0")];
            let finished = drive(file, &arguments);
            let summary = judged(&finished, &[]);
            no_contact(&summary, &what);
            for distance in final_distances(&summary) {
                assert!(distance <= 0.165, "{what}: {distance} m from the vertex");
                worst = worst.max(distance);
            }
        }
    }
    println!("worst final distance {worst:.4} m with profile thesis on the honest bed");
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
    let other = |argument| drive("square.launch.yaml", &[&arguments[..], &[argument]].concat()).digest;
    assert_ne!(first.digest, other(("seed", "2")), "another seed is another run");
    assert_ne!(first.digest, other(("noise", "thesis")), "noise is added");
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
