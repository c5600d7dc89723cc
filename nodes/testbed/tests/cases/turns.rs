//! Bridge and test bed together: the turn that tells a robot apart, while nothing else may move.

use crate::common::{Loop, Texts};
use trench_core::RosTime;
use trench_msgs::msg::{Identify, RunState};
use trench_msgs::nav_msgs::Odometry;

/// Headings of both robots after commands to both at 30 Hz for a third of a second, while robot 2 is asked to turn.
fn headings(state: u8, asked: bool, [v, omega]: [f64; 2], stop: bool) -> [f64; 2] {
    let mut both = Loop::new(&[0.4, 0.5, 0.0, 0.4, 1.2, 0.0], &[], &[], &Texts(Vec::new()));
    both.run_state(state);
    if stop {
        both.emergency_stop(9, true);
    }
    both.run(200);
    for _ in 0..10 {
        if asked {
            let mut identify = Identify { robot: "robot2".to_owned(), omega, ..Identify::default() };
            identify.header.stamp = RosTime(both.times().ros.0 - 40_000_000).into();
            both.publish("/identify", 7, &identify);
        }
        both.command(2, v, omega, 40);
        both.run(33);
    }
    both.run(300);
    [1, 2].map(|robot| {
        let odometry: Odometry = both.testbed.last(&format!("/ground_truth/robot{robot}/odom"));
        2.0 * odometry.pose.pose.orientation.z.atan2(odometry.pose.pose.orientation.w)
    })
}

#[test]
fn only_the_robot_that_is_asked_turns_and_only_on_the_spot() {
    let [other, turned] = headings(RunState::IDLE, true, [0.0, 1.0], false);
    assert!(other.abs() < 1e-6 && (0.2..0.45).contains(&turned), "{other} {turned}");
    for (why, asked, command, stop) in [
        ("nobody asks", false, [0.0, 1.0], false),
        ("that is no turn on the spot", true, [0.05, 1.0], false),
        ("that is too fast", true, [0.0, 2.0], false),
        ("emergency stop", true, [0.0, 1.0], true),
    ] {
        let headings = headings(RunState::ARMED, asked, command, stop);
        assert!(headings.iter().all(|heading| heading.abs() < 1e-6), "{why}: {headings:?}");
    }
}
