//! How old what drives a robot may be, and whose word counts, however commands come.

use crate::common::{Loop, MS};
use crate::{NO_FILES, running};
use trench_config::ParameterValue::{Bool, Double};
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::geometry_msgs::{Twist, TwistStamped};
use trench_msgs::msg::RunState;

#[test]
fn a_command_without_a_stamp_is_refused_where_stamps_are_expected() {
    let mut both = running();
    let mut unstamped = TwistStamped::default();
    unstamped.twist.linear.x = 0.07;
    for _ in 0..10 {
        both.publish("/robot1/cmd_vel", 1, &unstamped);
        both.run(33);
    }
    assert_eq!(both.place(1).0, 0.4, "nobody knows how old it is");
    let diagnostics: DiagnosticArray = both.bridge.last("/diagnostics");
    assert!(format!("{diagnostics:?}").contains("header: auto"), "{diagnostics:?}");
}

#[test]
fn unstamped_commands_that_waited_while_the_bridge_was_held_up_move_nobody() {
    let queued = |held_up: u64| {
        let mut both = Loop::new(&[0.4, 0.5, 0.0], &[("stamped", Bool(false))], &[], &NO_FILES);
        both.run_state(RunState::RUNNING);
        let mut twist = Twist::default();
        twist.linear.x = 0.07;
        for _ in 0..10 {
            both.publish("/robot1/cmd_vel", 1, &twist);
            both.run(33);
        }
        both.run_without_bridge(held_up);
        let x = both.place(1).0;
        both.publish("/robot1/cmd_vel", 1, &twist);
        both.run(90);
        both.place(1).0 - x
    };
    assert!(queued(30) > 0.002, "it goes on: {}", queued(30));
    assert_eq!(queued(1000), 0.0, "the command may be a second old");
}

#[test]
fn packets_that_take_long_in_the_air_drive_nobody_by_what_is_older_than_a_quarter_of_a_second() {
    let travelled = |delay: f64, age: u64| {
        let slow = [("radio.delay_min", Double(delay)), ("radio.delay_max", Double(delay))];
        let mut both = Loop::new(&[0.4, 0.5, 0.0], &[], &slow, &NO_FILES);
        both.run_state(RunState::RUNNING);
        // The robot's own measure of lateness begins with the delay: nobody drives before reports have said how long the way is.
        for _ in 0..60 {
            both.command(1, 0.07, 0.0, age);
            both.run(33);
        }
        both.place(1).0 - 0.4
    };
    assert!(
        travelled(0.004, 120) > 0.11 && travelled(0.06, 40) > 0.1,
        "{} {}",
        travelled(0.004, 120),
        travelled(0.06, 40)
    );
    assert_eq!(travelled(0.1, 120), 0.0, "120 ms old when it comes, 100 ms in the air, and as long to be known");
}

#[test]
fn one_robot_s_old_commands_do_not_stop_the_others() {
    let mut both = running();
    for _ in 0..30 {
        // Robot 1's information is so old that 10 ms are left of it: less than a frame.
        both.command(1, 0.07, 0.0, 212);
        both.command_to(2, 0.07, 0.0, 40);
        both.run(33);
    }
    assert_eq!(both.place(1).0, 0.4);
    let steady = both.track(2).iter().filter(|(_, _, _, v)| *v > 0.06).count();
    assert!(steady >= 27, "{steady} of 30 frames");
}

#[test]
fn a_port_without_a_base_station_is_named() {
    let mut both = Loop::new(&[0.4, 0.5, 0.0], &[], &[], &NO_FILES);
    let port = |both: &Loop| {
        let diagnostics: DiagnosticArray = both.bridge.last("/diagnostics");
        diagnostics.status.iter().find(|status| status.name.ends_with("serial port")).unwrap().message.clone()
    };
    both.run(1100);
    assert_eq!(port(&both), "open");
    both.is_connected = false;
    both.run(500);
    assert!(port(&both).contains("no base station answers"), "{}", port(&both));
}

#[test]
fn the_run_is_over_for_the_bridge_when_who_said_that_it_runs_has_gone() {
    let mut both = running();
    both.drive(20, 2, 0.07, 0.0);
    let x = both.place(1).0;
    both.presence("/run_state", 1, false);
    let halted = both.now;
    both.drive(40, 2, 0.07, 0.0);
    let moved = both.track(1).iter().filter(|(at, _, _, v)| *v > 0.0 && *at > (halted / MS) as f64 + 50.0).count();
    assert_eq!(moved, 0);
    assert!(both.place(1).0 < x + 0.01);
    both.presence("/run_state", 1, true);
    both.drive(40, 2, 0.07, 0.0);
    assert!(both.place(1).0 > x + 0.05, "the network had lost it for a while");
}
