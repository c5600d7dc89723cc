//! A localizer that comes back knows the robots again, or says that it does not.

use super::{START, build, detections_of, restart, send, timing};
use trench_core::{Action, NodeCore, RosTime};
use trench_msgs::Message;
use trench_msgs::msg::{RobotState, TeamState};
use trench_optics::Pose2;

const INPUT: &str = "    input: detections\n";
/// Not the start poses: places that the robots have driven to.
const AWAY: [Pose2; 2] = [Pose2 { x: 1.2, y: 0.9, theta: 2.0 }, Pose2 { x: 1.2, y: 0.6, theta: 1.0 }];

/// Shows `robots` to a core from frame `first` on and gives the checkpoints with the frames that made them.
fn show(core: &mut dyn NodeCore, first: u64, count: u64, robots: impl Fn(u64) -> Vec<Pose2>) -> Vec<(u64, Vec<u8>)> {
    let mut checkpoints = Vec::new();
    for sequence in first..first + count {
        let outbox = send(core, sequence, &detections_of(&robots(sequence), sequence, |_| ()));
        checkpoints.extend(outbox.actions.into_iter().filter_map(|action| match action {
            Action::Checkpoint(bytes) => Some((sequence, bytes)),
            _ => None,
        }));
    }
    checkpoints
}

/// From the start poses to [`AWAY`] within 100 frames, then standing there.
fn drive(sequence: u64) -> Vec<Pose2> {
    let part = (sequence as f64 / 100.0).min(1.0);
    let between = |from: Pose2, to: Pose2| Pose2 {
        x: from.x + part * (to.x - from.x),
        y: from.y + part * (to.y - from.y),
        theta: from.theta + part * (to.theta - from.theta),
    };
    START.iter().zip(AWAY).map(|(from, to)| between(*from, to)).collect()
}

/// The last checkpoint of a localizer that followed the robots to where they are.
fn left_behind() -> Vec<u8> {
    show(build(INPUT).unwrap().as_mut(), 1, 150, drive).pop().unwrap().1
}

/// What the localizer that starts at frame `first` says of the robots in that frame.
fn told(checkpoint: Vec<u8>, first: u64, robots: &[Pose2]) -> Vec<(u8, [f64; 2])> {
    let mut core = restart(INPUT, Some(checkpoint)).unwrap();
    let outbox = send(core.as_mut(), first, &detections_of(robots, first, |_| ()));
    let state: TeamState = outbox.last(0).unwrap();
    state.robots.iter().map(|robot| (robot.status, [robot.x, robot.y])).collect()
}

fn check(checkpoint: Vec<u8>, first: u64, robots: &[Pose2], expected: [(u8, Pose2); 2]) {
    let told = told(checkpoint, first, robots);
    for ((status, [x, y]), (as_expected, pose)) in told.iter().zip(expected) {
        assert_eq!(*status, as_expected, "{told:?}");
        assert!((x - pose.x).hypot(y - pose.y) < 1e-3, "{told:?}");
    }
}

const TRACKED: u8 = RobotState::STATUS_TRACKED;
const AMBIGUOUS: u8 = RobotState::STATUS_AMBIGUOUS;

#[test]
fn checkpoints_are_small_and_rare() {
    let checkpoints = show(build(INPUT).unwrap().as_mut(), 1, 350, drive);
    let between: Vec<u64> = checkpoints.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
    // Four seconds of driving, ten of standing.
    assert!(between.iter().all(|frames| (5..=50).contains(frames)), "{between:?}");
    assert!((19..=30).contains(&checkpoints.len()), "{}", checkpoints.len());
    assert!(checkpoints.iter().all(|(_, bytes)| bytes.len() < 512));
    let nothing_seen = show(build(INPUT).unwrap().as_mut(), 1, 100, |_| Vec::new());
    assert_eq!(nothing_seen, []);
}

#[test]
fn the_same_robots_are_known_in_the_first_frame() {
    // One second, and ten.
    for first in [176, 400] {
        check(left_behind(), first, &AWAY, [(TRACKED, AWAY[0]), (TRACKED, AWAY[1])]);
    }
}

#[test]
fn robots_that_drove_on_while_nobody_looked_are_known() {
    let checkpoints = show(build(INPUT).unwrap().as_mut(), 1, 60, drive);
    let (last, checkpoint) = checkpoints.last().unwrap().clone();
    // They stop a quarter of a second after the last news.
    let stopped = drive(last + 6);
    check(checkpoint, last + 25, &stopped, [(TRACKED, stopped[0]), (TRACKED, stopped[1])]);
}

#[test]
fn one_hidden_robot_does_not_take_the_others_pad() {
    let told = told(left_behind(), 176, &AWAY[1..]);
    assert_ne!(told[0].0, TRACKED);
    assert_eq!(told[1].0, TRACKED);
}

#[test]
fn robots_that_could_have_changed_places_are_in_doubt() {
    // Both have been moved to the middle between them.
    let moved = [Pose2 { x: 1.1, y: 0.75, ..AWAY[0] }, Pose2 { x: 1.3, y: 0.75, ..AWAY[1] }];
    let told = told(left_behind(), 400, &moved);
    assert!(told.iter().all(|(status, _)| *status == AMBIGUOUS), "{told:?}");
}

#[test]
fn a_new_experiment_begins_at_its_start_poses() {
    // Ten seconds later the robots are back at the start, and two minutes later.
    for first in [400, 3200] {
        check(left_behind(), first, &START, [(TRACKED, START[0]), (TRACKED, START[1])]);
    }
}

#[test]
fn what_is_no_checkpoint_is_ignored() {
    let good = left_behind();
    let mut later = TeamState::decode(&good).unwrap();
    later.header.stamp = RosTime(timing(150).0.0 + 3_000_000_000_000).into();
    let mut broken = TeamState::decode(&good).unwrap();
    broken.robots.iter_mut().for_each(|robot| robot.x = f64::NAN);
    let strangers = {
        let mut state = TeamState::decode(&good).unwrap();
        state.robots.iter_mut().for_each(|robot| robot.name = "someone".to_owned());
        state
    };
    let cdr = trench_msgs::Encode::to_cdr;
    for bytes in [good[..40].to_vec(), vec![7; 100], Vec::new(), cdr(&later), cdr(&broken), cdr(&strangers)] {
        check(bytes, 151, &START, [(TRACKED, START[0]), (TRACKED, START[1])]);
    }
}
