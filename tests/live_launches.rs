//! The launch files of chapters 5 to 9 as processes in real time, judged as tests/launches.rs judges them in lock-step, and the pursuit
//! among obstacles that lasers find.
//!
//! One a day; `TRENCH_LIVE_LAUNCH` names another (scripts/acceptance takes all).
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod live_support;
#[expect(dead_code, reason = "the experiments use the rest")]
mod support;

use live_support::{Launch, domain};
use std::time::SystemTime;
use support::conformity::Conformity;
use trench_bag::run::Run;

const FILES: [&str; 5] = ["chain", "nearest_chain", "corridor", "sinusoid", "lasers"];

/// m, from the segment at the end: `tolerance` of the launch files, and no more than in lock-step.
const STANDS: f64 = 0.05;

fn file() -> String {
    let today = || SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap().as_secs() / 86_400;
    std::env::var("TRENCH_LIVE_LAUNCH").unwrap_or_else(|_| FILES[(today() % FILES.len() as u64) as usize].to_owned())
}

/// What is particular to a file.
fn is_as_in_lockstep(file: &str, run: &Run) {
    let end = |robot: &str| run.robots[robot].poses.last().unwrap();
    let robots = run.robots.keys();
    match file {
        "chain" => assert_eq!(robots.len(), 8),
        // Past all discs, the last of which lies 2.4 m up the diagonal.
        "nearest_chain" => {
            robots.for_each(|robot| assert!(end(robot).x > 2.5, "{robot} is behind at {}", end(robot).x))
        }
        "corridor" => {
            for (robot, track) in &run.robots {
                let inside = track.poses.iter().filter(|pose| (1.1..2.7).contains(&pose.x));
                let widest = inside.map(|pose| (pose.y - 1.4).abs()).fold(0.0, f64::max);
                assert!(widest > 0.0 && widest < 0.27, "{robot} goes through: {widest} m beside the middle");
                assert!(end(robot).x > 2.6, "{robot}");
            }
        }
        "sinusoid" => assert_eq!(robots.len(), 15),
        // Behind the target, at the end of its way through the field.
        "lasers" => robots.for_each(|robot| assert!(end(robot).x < 2.0 && end(robot).y > 1.6, "{robot} is lost")),
        other => assert!(FILES.contains(&other), "{other} is none of {FILES:?}"),
    }
}

#[test]
fn live_a_launch_file_of_the_chapters_stands() {
    let file = file();
    let launch = Launch::new(domain(0));
    let (launched, arguments) = match file.as_str() {
        "lasers" => (
            "pursuit",
            support::by_lasers(launch.folder.path()).map(|(name, value)| format!("{name}:={value}")).to_vec(),
        ),
        other => (other, Vec::new()),
    };
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let (status, text) = launch.finish(launch.recording(&format!("{launched}.launch.yaml"), &arguments));
    assert!(status.success(), "{file}: {status}\n{text}");
    let bag = launch.recorded();
    let run = Run::from_bag(&bag).unwrap();
    let summary = launch.judge(&[]);
    assert!(run.contacts.is_empty(), "{file}: {:?}", run.contacts);
    let gap = summary.closest.as_ref().unwrap().gap;
    assert!(gap > 0.0, "{file}: {summary}");
    let mut conformity = Conformity::default();
    for message in bag.messages() {
        let message = message.unwrap();
        conformity.take(&bag.topics()[message.topic].name, &message);
    }
    let worst = conformity.finish().at_the_end();
    println!("worst at the end {worst:.4} m ({file}), bodies {gap:.3} m apart at the least");
    assert!(worst <= STANDS, "{file}: {worst} m");
    is_as_in_lockstep(&file, &run);
}
