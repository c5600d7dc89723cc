//! A robot that does not do what it is told is an obstacle to all, and so is one that says nothing (invariant 8).

use crate::bench::{Bench, PERIOD, formation};
use trench_formation::kinematics::{Pose, Twist};
use trench_msgs::msg::{LeaderState, RobotState};

/// Whether robot1 said in its last tick that it deviates.
fn deviates(bench: &Bench) -> bool {
    let said: LeaderState = bench.out.last(bench.port("/robot1/leader_state")).unwrap();
    said.limited_by & LeaderState::LIMIT_DEVIATES != 0
}

#[test]
fn a_robot_that_is_held_says_so_until_it_does_as_it_is_told() {
    let mut bench = Bench::new();
    let began = bench.seconds;
    while !deviates_after_a_tick_at_rest(&mut bench) {
        assert!(bench.seconds < began + 1.0, "held for a second");
    }
    let elapsed = bench.seconds - began;
    // The commands of the last 0.15 s explain what is seen, and 0.3 s are forgiven.
    assert!((0.45..0.7).contains(&elapsed), "{elapsed} s");
    let command = bench.last_command().twist;
    (bench.pose, bench.twist) = (Pose::new(1.0, 0.9, 0.0), Twist { v: command.linear.x, omega: command.angular.z });
    bench.drive(1);
    assert!(!deviates(&bench), "it is let go");
}

fn deviates_after_a_tick_at_rest(bench: &mut Bench) -> bool {
    bench.running();
    bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
    bench.seconds += PERIOD;
    deviates(bench)
}

/// What robot2 says of itself.
#[derive(Clone, Copy)]
enum Says {
    Obeys,
    Deviates,
    Nothing,
}

/// The speeds (m/s) at which robot1 comes near robot2, which crosses its way; what robot2 says after the first half second.
fn approach(says: Says) -> Vec<f64> {
    let mut bench = Bench::new();
    formation(&mut bench);
    let mut speeds = Vec::new();
    for tick in 0..35 {
        let (heard, limited_by) = match says {
            _ if tick < 15 => (true, 0),
            Says::Obeys => (true, 0),
            Says::Deviates => (true, LeaderState::LIMIT_DEVIATES),
            Says::Nothing => (false, 0),
        };
        if heard {
            let mut state = LeaderState { epoch: 4, formation_hash: 7, rank: 1, limited_by, ..Default::default() };
            state.robot = "robot2".to_owned();
            state.goal_distance = 1.0;
            state.header.stamp = bench.times().ros.into();
            bench.send("/robot2/leader_state", &state);
        }
        bench.running();
        let mut team = bench.team(RobotState::STATUS_TRACKED, 0.0);
        let robot = &mut team.robots[0];
        (robot.x, robot.y, robot.theta) = (bench.pose.x, bench.pose.y, bench.pose.theta);
        (robot.v, robot.omega) = (bench.twist.v, bench.twist.omega);
        let (theta, status) = (-std::f64::consts::FRAC_PI_2, RobotState::STATUS_TRACKED);
        let name = "robot2".to_owned();
        team.robots.push(RobotState { name, status, x: 1.45, y: 0.9, theta, v: 0.25, ..Default::default() });
        let command = bench.tick(&team).twist;
        speeds.push(command.linear.x);
        bench.twist = Twist { v: command.linear.x, omega: command.angular.z };
        bench.pose = bench.pose.advanced(bench.twist, PERIOD);
        bench.seconds += PERIOD;
    }
    speeds
}

#[test]
fn who_deviates_or_is_silent_gets_no_half_of_the_gap_to_keep_to() {
    let [obeys, deviates, silent] = [Says::Obeys, Says::Deviates, Says::Nothing].map(approach);
    assert_eq!(obeys[..15], deviates[..15]);
    let slower = |speeds: &[f64]| speeds.iter().zip(&obeys).filter(|(slow, fast)| *slow < &(*fast - 0.02)).count();
    assert!(slower(&deviates) >= 3, "{obeys:.3?}\n{deviates:.3?}");
    // The last word of the silent one counts for 0.3 s.
    assert_eq!(silent[..23], obeys[..23]);
    assert!(slower(&silent) >= 3, "{obeys:.3?}\n{silent:.3?}");
}
