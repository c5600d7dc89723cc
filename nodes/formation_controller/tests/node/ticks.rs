//! What a tick makes of what was heard.

use crate::bench::{Bench, PERIOD, formation};
use trench_core::{Event, RosTime};
use trench_msgs::Encode;
use trench_msgs::geometry_msgs::TwistStamped;
use trench_msgs::msg::{ApparentObstacleArray, Goal, Goals, LeaderState, Point2, RobotState, RunState, TeamState};
use trench_msgs::std_msgs::Bool;

#[test]
fn drives_ahead_as_fast_as_the_steppers_start() {
    let mut bench = Bench::new();
    bench.running();
    let command = bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.035));
    assert!((command.twist.linear.x - 0.08).abs() < 1e-9, "pull-in speed: {command:?}");
    assert!(command.twist.angular.z.abs() < 1e-9);
    let state: LeaderState = bench.out.last(bench.port("/robot1/leader_state")).unwrap();
    assert_eq!(state.robot, "robot1");
    assert!((state.goal_distance - 0.5).abs() < 1e-6 && state.lyapunov_rate < 0.0, "{state:?}");
    assert_eq!(state.limited_by, LeaderState::LIMIT_WHEELS | LeaderState::LIMIT_RAMP);
}

#[test]
fn rests_unless_everything_is_there() {
    let rests = |prepare: &dyn Fn(&mut Bench) -> TeamState, reason: &str| {
        let mut bench = Bench::new();
        bench.running();
        let team = prepare(&mut bench);
        let command = bench.tick(&team);
        assert_eq!((command.twist.linear.x, command.twist.angular.z), (0.0, 0.0), "{reason}");
    };
    let tracked = RobotState::STATUS_TRACKED;
    rests(
        &|bench| {
            bench.send("/run_state", &RunState { state: RunState::ARMED, ..Default::default() });
            bench.team(tracked, 0.0)
        },
        "armed is not running",
    );
    rests(&|bench| bench.team(RobotState::STATUS_LOST, 0.0), "lost");
    rests(&|bench| bench.team(RobotState::STATUS_AMBIGUOUS, 0.0), "in doubt");
    rests(&|bench| bench.team(tracked, 0.2), "an old pose");
    rests(&|bench| bench.team(tracked, -0.02), "a pose from the future");
    rests(&|_| TeamState::default(), "no pose at all");
    rests(
        &|bench| {
            bench.seconds += 0.6;
            bench.team(tracked, 0.0)
        },
        "old goals and obstacles",
    );
    rests(
        &|bench| {
            bench.send("/emergency_stop", &Bool { data: true });
            bench.team(tracked, 0.0)
        },
        "emergency stop",
    );
}

#[test]
fn the_reason_is_on_diagnostics() {
    let mut bench = Bench::new();
    bench.running();
    bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
    bench.tick(&bench.team(RobotState::STATUS_LOST, 0.0));
    assert!(bench.says().contains("resting: the localizer has lost the robot"), "{}", bench.says());
}

#[test]
fn an_emergency_stop_does_not_wait_for_the_next_frame() {
    let mut bench = Bench::new();
    bench.running();
    bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
    bench.out.take();
    bench.send("/emergency_stop", &Bool { data: true });
    assert_eq!(bench.last_command().twist.linear.x, 0.0);
}

#[test]
fn silence_stops_the_robot() {
    let mut bench = Bench::new();
    bench.running();
    assert!(bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.03)).twist.linear.x > 0.0);
    let mut commands = Vec::new();
    for _ in 0..4 {
        let due = bench.core.next_wakeup().unwrap();
        bench.seconds = due.0 as f64 * 1e-9;
        bench.core.handle(bench.times(), Event::Wakeup, &mut bench.out);
        commands.push(bench.last_command().twist.linear.x);
    }
    assert!(commands[0] > 0.0, "one lost frame does not stop a robot: {commands:?}");
    assert_eq!(commands[1..], [0.0, 0.0, 0.0], "a pose older than 0.12 s does: {commands:?}");
}

/// One from the future neither drives the robot nor makes those after it late; nor does one from the past.
#[test]
fn team_states_of_another_time_do_not_count() {
    let mut bench = Bench::new();
    bench.running();
    let tracked = RobotState::STATUS_TRACKED;
    assert!(bench.tick(&bench.team(tracked, 0.03)).twist.linear.x > 0.0);
    bench.out.take();
    bench.send("/team_state", &bench.team(tracked, -5.0));
    assert!(bench.says().contains("5.000 s from the future"), "{}", bench.says());
    bench.send("/team_state", &bench.team(tracked, 3.0));
    assert!(bench.out.published::<TwistStamped>(bench.port("/robot1/cmd_vel")).is_empty());
    bench.seconds += 0.033;
    assert!(bench.tick(&bench.team(tracked, 0.03)).twist.linear.x > 0.0);
}

#[test]
fn obstacles_and_goals_of_another_time_do_not_count() {
    for (topic, shift, said) in [
        ("/apparent_obstacles", 5.0, "5.000 s from the future"),
        ("/apparent_obstacles", -3.0, "3.000 s older than one heard before"),
        ("/goals", 5.0, "5.000 s from the future"),
        ("/goals", -3.0, "3.000 s older than one heard before"),
    ] {
        let mut bench = Bench::new();
        bench.running();
        let before = bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0)).twist.linear.x;
        bench.seconds += PERIOD;
        let stamp = RosTime(0).plus_seconds(100.0 + if shift > 0.0 { PERIOD + shift } else { shift }).into();
        // In the way, and behind.
        let mut hulls =
            ApparentObstacleArray { obstacles: vec![Default::default()], ..ApparentObstacleArray::default() };
        hulls.obstacles[0].hull = vec![Point2 { x: 1.15, y: 0.9 }];
        hulls.obstacles[0].radius = 0.02;
        let goal = Goal { robot: "robot1".to_owned(), position: Point2 { x: 0.1, y: 0.9 }, ..Goal::default() };
        let mut goals = Goals { goals: vec![goal], ..Goals::default() };
        hulls.header.stamp = stamp;
        goals.header.stamp = hulls.header.stamp;
        bench.send(topic, if topic == "/goals" { &goals as &dyn Encode } else { &hulls });
        assert!(bench.says().contains(&format!("a message on {topic} was dropped: it is {said}")), "{}", bench.says());
        let after = bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0)).twist.linear.x;
        assert!(after >= before, "{topic} {shift}: {before}, then {after}");
    }
}

/// As after a bag that begins anew, or a simulated clock that was reset.
#[test]
fn a_clock_that_is_set_back_makes_nothing_late() {
    let mut bench = Bench::new();
    bench.running();
    let tracked = RobotState::STATUS_TRACKED;
    assert!(bench.tick(&bench.team(tracked, 0.03)).twist.linear.x > 0.0);
    let team = bench.team(tracked, 0.03);
    bench.behind = 3.0;
    bench.running();
    let mut earlier = team;
    earlier.header.stamp = bench.times().ros.plus_seconds(-0.03).into();
    assert!(bench.tick(&earlier).twist.linear.x > 0.0);
}

/// Ticks that come of it would drive the law faster than time goes on.
#[test]
fn only_a_new_emergency_stop_is_urgent() {
    let mut bench = Bench::new();
    bench.running();
    bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
    bench.out.take();
    bench.send("/emergency_stop", &Bool { data: false });
    assert!(bench.out.published::<TwistStamped>(bench.port("/robot1/cmd_vel")).is_empty());
}

#[test]
fn goals_of_another_time_do_not_count() {
    let mut bench = Bench::new();
    bench.running();
    let mut late = Goals::default();
    late.header.stamp = bench.times().ros.plus_seconds(-0.4).into();
    bench.send("/goals", &late);
    late.header.stamp = bench.times().ros.plus_seconds(0.4).into();
    bench.send("/goals", &late);
    assert!(bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0)).twist.linear.x > 0.0, "the good one is in force");
    assert!(bench.says().contains("was dropped"), "{}", bench.says());
}

#[test]
fn numbers_that_are_none_never_reach_the_wheels() {
    for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e308] {
        for (field, on_a_segment, whose) in
            (0..5).flat_map(|field| [(field, false, 0), (field, true, 0), (field, false, 1), (field, true, 1)])
        {
            let mut bench = Bench::new();
            bench.others = vec![RobotState { name: "robot2".to_owned(), status: 1, x: 1.9, ..RobotState::default() }];
            if on_a_segment {
                // Where it is from its segment is told to the others.
                formation(&mut bench);
            }
            bench.running();
            bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
            bench.seconds += PERIOD;
            let mut team = bench.team(RobotState::STATUS_TRACKED, 0.0);
            let robot = &mut team.robots[whose];
            *[&mut robot.x, &mut robot.y, &mut robot.theta, &mut robot.v, &mut robot.omega][field] = bad;
            let what = format!("{bad} in field {field} of robot {whose}");
            let command = bench.tick(&team).twist;
            assert!(command.linear.x.is_finite() && command.angular.z.is_finite(), "{what}");
            assert!(command.linear.x.abs() <= 0.3, "{what}");
            let said = bench.says().contains("a message on /team_state was dropped: a number in it is not finite");
            assert_eq!(said, !bad.is_finite(), "{what}: {}", bench.says());
        }
    }
}

#[test]
fn goals_with_numbers_that_are_none_leave_the_last_ones_in_force() {
    for (bad, field) in [f64::NAN, f64::INFINITY].into_iter().flat_map(|bad| (0..6).map(move |field| (bad, field))) {
        let mut bench = Bench::new();
        bench.running();
        let first = bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0)).twist.linear.x;
        bench.seconds += PERIOD;
        let goal = Goal { robot: "robot1".to_owned(), position: bench.goal, remaining: 1e9, ..Goal::default() };
        let mut goals = Goals { goals: vec![goal], ..Goals::default() };
        goals.header.stamp = bench.times().ros.into();
        let Goals { frame, goals: each, .. } = &mut goals;
        let goal = &mut each[0];
        *[
            &mut goal.position.x,
            &mut goal.velocity.y,
            &mut goal.acceleration.x,
            &mut goal.remaining,
            &mut frame.theta,
            &mut frame.position.y,
        ][field] = bad;
        bench.send("/goals", &goals);
        assert!(bench.says().contains("a message on /goals was dropped: a number in it is not finite"), "{field}");
        let next = bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0)).twist.linear.x;
        assert!(next >= first, "{bad} in field {field}: {first}, then {next}");
    }
}

#[test]
fn garbage_is_counted_and_dropped() {
    let mut bench = Bench::new();
    bench.running();
    bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
    for garbage in [&[][..], &[0, 1], &[0xff; 64], &[0, 1, 0, 0, 0xff, 0xff, 0xff, 0xff]] {
        bench.send_bytes("/team_state", garbage);
        bench.send_bytes("/robot2/leader_state", garbage);
    }
    assert!(bench.says().contains("was dropped"), "{}", bench.says());
    let again = bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
    assert!(again.twist.linear.x > 0.0, "the last good messages are still in force");
}

#[test]
fn what_is_carried_forward_drives_nobody_for_long() {
    let driven = |unseen: u32| {
        let mut bench = Bench::new();
        bench.running();
        let mut team = bench.team(RobotState::STATUS_PREDICTED, 0.04);
        team.robots[0].unseen.nanosec = unseen;
        let command = bench.tick(&team);
        let age = RosTime(0).plus_seconds(100.0).seconds_since(RosTime::from(&command.header.stamp));
        (command.twist.linear.x > 0.0, (1e3 * age).round())
    };
    assert_eq!(driven(0), (true, 40.0));
    assert_eq!(driven(200_000_000), (true, 240.0));
    assert_eq!(driven(220_000_000), (false, 260.0));
}

/// Who speaks nonsense fifty times a second does not have the place of a localizer that dies, nor of one that comes later.
#[test]
fn nonsense_takes_nobodys_place() {
    let nonsense: [&dyn Fn(&mut TeamState); 3] = [
        &|team| team.robots[0].x = f64::NAN,
        &|team| team.header.stamp = RosTime(0).plus_seconds(7200.0).into(),
        &|team| team.header.stamp = RosTime(0).plus_seconds(1.0).into(),
    ];
    for (index, spoil) in nonsense.into_iter().enumerate() {
        for is_first in [false, true] {
            let mut bench = Bench::new();
            let frames = |bench: &mut Bench, count: u32, gid: Option<u8>| {
                for _ in 0..count {
                    bench.running();
                    let mut strange = bench.team(RobotState::STATUS_TRACKED, 0.0);
                    spoil(&mut strange);
                    bench.send_from([9; 16], "/team_state", &strange.to_cdr());
                    if let Some(gid) = gid {
                        let team = bench.team(RobotState::STATUS_TRACKED, 0.0);
                        bench.send_from([gid; 16], "/team_state", &team.to_cdr());
                    }
                    bench.seconds += PERIOD;
                }
            };
            if !is_first {
                frames(&mut bench, 10, Some(1));
            }
            // The localizer is dead for 0.7 s, and another one comes.
            frames(&mut bench, 21, None);
            frames(&mut bench, 6, Some(2));
            assert!(bench.last_command().twist.linear.x > 0.0, "{index} {is_first}: {}", bench.says());
        }
    }
}
