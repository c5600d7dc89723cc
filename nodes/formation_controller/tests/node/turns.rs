//! The turn on the spot by which the localizer finds out which robot this is.

use crate::bench::Bench;
use trench_msgs::msg::{Identify, RobotState};
use trench_msgs::std_msgs::Bool;

/// The turning speed of a robot with this status that is asked to turn, and its forward speed.
fn asked_to_turn(status: u8, age: f64, robot: &str, omega: f64, stop: bool) -> [f64; 2] {
    let mut bench = Bench::new();
    let mut identify = Identify { robot: robot.to_owned(), omega, ..Default::default() };
    identify.header.stamp = bench.times().ros.plus_seconds(-age).into();
    if stop {
        bench.send("/emergency_stop", &Bool { data: true });
    }
    bench.send("/identify", &identify);
    let command = bench.tick(&bench.team(status, 0.035));
    [command.twist.angular.z, command.twist.linear.x]
}

#[test]
fn a_robot_that_nobody_knows_turns_when_it_is_asked_and_no_other_does() {
    let doubtful = RobotState::STATUS_AMBIGUOUS;
    assert_eq!(asked_to_turn(doubtful, 0.035, "robot1", -1.0, false), [-1.0, 0.0]);
    assert_eq!(asked_to_turn(RobotState::STATUS_LOST, 0.035, "robot1", 1.0, false), [1.0, 0.0]);
    assert_eq!(asked_to_turn(doubtful, 0.035, "robot1", 9.0, false), [1.2, 0.0], "no faster than steppers start");
    for (status, age, robot, omega, stop, why) in [
        (RobotState::STATUS_TRACKED, 0.035, "robot1", 1.0, false, "it is known"),
        (doubtful, 0.035, "robot2", 1.0, false, "another one is asked"),
        (doubtful, 0.2, "robot1", 1.0, false, "that was long ago"),
        (doubtful, -0.2, "robot1", 1.0, false, "from the future"),
        (doubtful, 0.035, "robot1", f64::NAN, false, "not a number"),
        (doubtful, 0.035, "robot1", 1.0, true, "emergency stop"),
    ] {
        assert_eq!(asked_to_turn(status, age, robot, omega, stop), [0.0, 0.0], "{why}");
    }
}

#[test]
fn a_turn_ends_when_nobody_asks_any_more() {
    let mut bench = Bench::new();
    let mut identify = Identify { robot: "robot1".to_owned(), omega: 1.0, ..Default::default() };
    identify.header.stamp = bench.times().ros.into();
    bench.send("/identify", &identify);
    assert!(bench.tick(&bench.team(RobotState::STATUS_AMBIGUOUS, 0.035)).twist.angular.z > 0.9);
    bench.seconds += 0.13;
    assert_eq!(bench.tick(&bench.team(RobotState::STATUS_AMBIGUOUS, 0.035)).twist.angular.z, 0.0);
}
