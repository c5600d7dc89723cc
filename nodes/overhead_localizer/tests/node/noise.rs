//! The noise of 4.5.3, which a parameter adds to measured poses.

use super::{START, build, detections, send};
use trench_msgs::msg::{RobotState, TeamState};

/// Frames of a robot at rest.
const FRAMES: u64 = 2_000;

/// Root mean square of how far published x, y, heading are from where the robot stands, and what the localizer says it is (square root of the
/// mean variance).
fn spread(noise: &str) -> [(f64, f64); 3] {
    let mut core = build(&format!("    input: detections\n    added_noise.sigma: {noise}\n")).unwrap();
    let mut states: Vec<RobotState> = Vec::new();
    for sequence in 1..=FRAMES {
        let state: TeamState = send(core.as_mut(), sequence, &detections(sequence, |_| ())).last(0).unwrap();
        states.push(state.robots[0].clone());
    }
    // The filter has settled.
    let settled = &states[100..];
    let mean = |of: &dyn Fn(&RobotState) -> f64| settled.iter().map(of).sum::<f64>() / settled.len() as f64;
    let of = |error: &dyn Fn(&RobotState) -> f64, index: usize| {
        let seen = mean(&|state| error(state) * error(state)).sqrt();
        (seen, mean(&|state| state.pose_covariance[index]).sqrt())
    };
    let [true_pose, _] = START;
    [
        of(&|state| state.x - true_pose.x, 0),
        of(&|state| state.y - true_pose.y, 4),
        of(&|state| state.theta - true_pose.theta, 8),
    ]
}

#[test]
fn published_poses_have_the_noise_that_is_asked_for_as_far_as_the_filter_leaves_it() {
    let sigma = [0.00046, 0.00049, 0.0122];
    let without = spread("[0.0, 0.0, 0.0]");
    assert!(without.iter().all(|(seen, _)| *seen < 2e-5), "{without:?}");
    let with = spread("[0.00046, 0.00049, 0.0122]");
    for ((seen, said), sigma) in with.into_iter().zip(sigma) {
        assert!((0.2 * sigma..1.05 * sigma).contains(&seen), "{with:?}");
        assert!((0.6..1.6).contains(&(said / seen)), "it knows how uncertain it is: {with:?}");
    }
    let doubled = spread("[0.00092, 0.00098, 0.0244]");
    for ((once, _), (twice, _)) in with.into_iter().zip(doubled) {
        assert!((1.2..2.2).contains(&(twice / once)), "{with:?} {doubled:?}");
    }
}
