//! Followers and what they hear of the robots ahead.

use crate::bench::{Bench, PERIOD, formation, make};
use trench_core::RosTime;
use trench_msgs::Encode;
use trench_msgs::geometry_msgs::TwistStamped;
use trench_msgs::msg::{Assignment, LeaderState, LinkStatus, Member, Point2, RobotState};

/// robot1 follows robot2 in a chain on the segment y = 0.9, in the frame of the map.
fn follower() -> Bench {
    let core = make(&[("team", "[robot1, robot2]"), ("law", "chain")]).unwrap();
    let mut bench = Bench::of(core);
    bench.running();
    formation(&mut bench);
    bench
}

fn leader_at(bench: &Bench, x: f64, epoch: u64) -> LeaderState {
    let mut state = LeaderState { epoch, formation_hash: 7, rank: 1, ..Default::default() };
    state.header.stamp = bench.times().ros.plus_seconds(-0.035).into();
    state.point = Point2 { x, y: 0.9 };
    state
}

/// The leader is believed to go on for 0.4 s; then the follower slows down by its acceleration of 0.35 m/s^2, and rests.
#[test]
fn a_follower_goes_after_its_leader_and_slows_and_rests_when_that_is_silent() {
    let mut bench = follower();
    let fastest = follow(&mut bench, 30, Some(1.9));
    assert!(fastest > 0.05, "{fastest}");
    let silent = "robot2, ahead in the chain, is silent";
    let (before, mut speeds) = (bench.seconds - PERIOD, Vec::new());
    while bench.seconds < before + 1.25 {
        let v = follow(&mut bench, 1, None);
        let elapsed = bench.seconds - PERIOD - before;
        assert_eq!(bench.says().contains(silent), elapsed > 0.4 - 0.035, "{elapsed} s: {}", bench.says());
        if elapsed > 0.4 - 0.035 {
            speeds.push(v);
        }
    }
    // The mean over a tick is sent.
    let step = 0.35 * PERIOD + 1e-6;
    assert!(speeds[0] >= fastest - step, "not at once: {fastest}, then {speeds:?}");
    let ramp = |pair: &[f64]| pair[1] == 0.0 && pair[0] <= 1.5 * step || (pair[0] - pair[1] - step).abs() < 1e-3 * step;
    assert!(speeds.windows(2).all(ramp), "{fastest}, then {speeds:?}");
    let moving = speeds.iter().take_while(|v| **v > 0.0).count();
    assert!(moving as f64 >= fastest / step - 1.5, "{moving} ticks: {fastest}, then {speeds:?}");
    assert!(speeds[moving..].iter().all(|v| *v == 0.0) && moving < speeds.len(), "{speeds:?}");
}

/// So many ticks of a follower, with its leader at `leader` (m along the segment) if it speaks; gives the highest speed.
fn follow(bench: &mut Bench, ticks: u32, leader: Option<f64>) -> f64 {
    let mut fastest = 0.0_f64;
    for _ in 0..ticks {
        bench.running();
        if let Some(x) = leader {
            bench.send("/robot2/leader_state", &leader_at(bench, x, 4));
        }
        let v = bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0)).twist.linear.x;
        fastest = fastest.max(v);
        bench.seconds += PERIOD;
    }
    fastest
}

/// With `encroaching: places` a follower keeps out of the place that its leader has chosen before the leader is there.
#[test]
fn a_follower_leaves_its_leader_the_place_that_it_has_chosen() {
    let chosen = |encroaching: &str| {
        let core = make(&[("team", "[robot1, robot2]"), ("law", "chain"), ("encroaching", encroaching)]).unwrap();
        let mut bench = Bench::of(core);
        formation(&mut bench);
        let mut places = Vec::new();
        for _ in 0..10 {
            bench.running();
            let mut state = leader_at(&bench, 1.9, 4);
            // Beside the robot, which is at 1.0 and steers a point 0.05 m ahead of it; its zone 2 reaches 0.26 m.
            state.place = Point2 { x: 1.1, y: 0.9 };
            bench.send("/robot2/leader_state", &state);
            bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
            bench.seconds += PERIOD;
            let said: LeaderState = bench.out.last(bench.port("/robot1/leader_state")).unwrap();
            places.push(said.place.x);
        }
        places[places.len() - 1]
    };
    assert!((chosen("places") - (1.1 - 0.26)).abs() < 1e-6, "{}", chosen("places"));
    assert!((chosen("robots") - 1.05).abs() < 0.01, "who is not there yet takes nothing: {}", chosen("robots"));
}

#[test]
fn a_robot_that_rests_says_that_its_place_is_where_it_is() {
    let mut bench = follower();
    bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
    let said: LeaderState = bench.out.last(bench.port("/robot1/leader_state")).unwrap();
    assert!((said.place.x - 1.05).abs() < 1e-9 && (said.place.y - 0.9).abs() < 1e-9, "{said:?}");
    assert_eq!(said.error_bound, f64::INFINITY, "nothing bounds the errors of law (7.13)");
}

#[test]
fn a_follower_that_hears_nobody_goes_along_the_segment_until_it_does() {
    let mut bench = follower();
    follow(&mut bench, 30, Some(1.9));
    follow(&mut bench, 75, None);
    assert!(bench.last_command().twist.linear.x > 0.1, "as fast as it may: {:?}", bench.last_command());
    assert!(bench.says().contains("hears nobody of its queue"), "{}", bench.says());
    follow(&mut bench, 18, Some(1.9));
    assert!(!bench.says().contains("hears nobody of its queue"), "{}", bench.says());
    let state: LeaderState = bench.out.last(bench.port("/robot1/leader_state")).unwrap();
    assert_eq!(state.hears, ["robot2"]);
}

/// The way to the team is told by the goals' frame: old goals lead nobody, whether it hears its team or not.
#[test]
fn a_lost_robot_that_hears_no_goals_either_rests() {
    let mut bench = follower();
    follow(&mut bench, 30, Some(1.9));
    follow(&mut bench, 75, None);
    assert!(bench.says().contains("hears nobody of its queue"), "{}", bench.says());
    // That of the tick before.
    let heard = bench.seconds - PERIOD;
    while bench.seconds < heard + 3.0 {
        bench.running_without_goals();
        let command = bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
        let is_old = bench.seconds - heard > 0.45;
        assert_eq!(command.twist.linear.x == 0.0, is_old, "{} s: {command:?}", bench.seconds - heard);
        assert_eq!(bench.says().contains("no goal is heard"), is_old, "{}", bench.says());
        bench.seconds += PERIOD;
    }
    follow(&mut bench, 75, None);
    assert!(bench.last_command().twist.linear.x > 0.1, "with goals it goes on: {}", bench.says());
}

#[test]
fn a_follower_without_a_leader_is_drawn_to_its_goal() {
    let mut bench = follower();
    let member = |robot: &str, rank| Member { robot: robot.to_owned(), rank, ..Default::default() };
    let members = vec![member("robot2", 1), member("robot1", 2)];
    bench.send("/assignment", &Assignment { epoch: 5, formation_hash: 7, members, ..Default::default() });
    follow(&mut bench, 30, None);
    assert!(bench.last_command().twist.linear.x > 0.05, "{}", bench.says());
    let state: LeaderState = bench.out.last(bench.port("/robot1/leader_state")).unwrap();
    assert!((state.goal.x - 1.5).abs() < 0.01, "{state:?}");
}

#[test]
fn leader_states_beyond_the_radio_s_reach_are_not_heard() {
    let mut bench = follower();
    let link = |hears: &[&str]| LinkStatus {
        up: true,
        hears: hears.iter().map(|name| (*name).to_owned()).collect(),
        ..Default::default()
    };
    for _ in 0..30 {
        bench.send("/robot1/link", &link(&["robot3"]));
        follow(&mut bench, 1, Some(1.9));
    }
    assert!(bench.says().contains("robot2, ahead in the chain, is silent"), "{}", bench.says());
    for _ in 0..30 {
        bench.send("/robot1/link", &link(&["robot2"]));
        follow(&mut bench, 1, Some(1.9));
    }
    assert!(bench.says().contains("driving"), "{}", bench.says());
    let network = [("team", "[robot1, robot2]"), ("law", "chain"), ("team_link", "network")];
    let mut bench = Bench::of(make(&network).unwrap());
    bench.send("/robot1/link", &link(&[]));
    follow(&mut bench, 1, Some(1.9));
    let state: LeaderState = bench.out.last(bench.port("/robot1/leader_state")).unwrap();
    assert_eq!(state.hears, ["robot2"], "on the robots' own hosts what comes is heard");
}

#[test]
fn a_second_publisher_waits_until_the_first_is_silent() {
    let mut bench = follower();
    follow(&mut bench, 10, Some(1.9));
    let mut team = bench.team(RobotState::STATUS_TRACKED, 0.0);
    team.robots[0].x = 0.3;
    bench.out.take();
    bench.send_from([9; 16], "/team_state", &team.to_cdr());
    assert!(bench.out.published::<TwistStamped>(bench.port("/robot1/cmd_vel")).is_empty(), "no tick of its own");
    assert!(bench.says().contains("another publisher writes this topic"), "{}", bench.says());
}

#[test]
fn leader_states_of_another_epoch_or_time_do_not_count() {
    let refused = |spoil: &dyn Fn(&mut LeaderState), expected: &str| {
        let mut bench = follower();
        let mut state = leader_at(&bench, 1.9, 4);
        spoil(&mut state);
        bench.send("/robot2/leader_state", &state);
        let command = bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
        assert_eq!(command.twist.linear.x, 0.0, "{expected}");
        assert!(bench.says().contains(expected), "{}", bench.says());
    };
    refused(&|state| state.epoch = 3, "it is of epoch 3, ours is 4");
    refused(&|state| state.formation_hash = 8, "of another formation");
    refused(&|state| state.header.stamp = RosTime(0).plus_seconds(105.0).into(), "from the future");
    refused(&|state| state.point.x = f64::NAN, "not finite");
}

/// Each tick one, of the exposure that it rests on; a follower hears them and so is never late by more than one.
#[test]
fn every_tick_has_one_leader_state() {
    let mut bench = follower();
    let port = bench.port("/robot1/leader_state");
    let mut exposures = Vec::new();
    for tick in 0..60 {
        exposures.push(bench.times().ros);
        // Whatever else comes in between makes no further one.
        let heard = 1 + tick % 3;
        (0..heard).for_each(|_| bench.send("/robot2/leader_state", &leader_at(&bench, 1.9, 4)));
        bench.running();
        bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
        bench.seconds += PERIOD;
    }
    let said = bench.out.published::<LeaderState>(port);
    let stamps: Vec<RosTime> = said.iter().map(|state| RosTime::from(&state.header.stamp)).collect();
    assert_eq!(stamps, exposures);
}

/// robot2, of another queue, comes from ahead on the left. Who says that it obeys its commands is left half of the gap; who does not obey, or says
/// nothing, may use up all of it, and robot1 brakes harder.
#[test]
fn what_robots_of_other_queues_say_counts() {
    let brakes_to = |limited_by: Option<u8>| {
        let mut bench = Bench::new();
        bench.goal.x = 2.6;
        let member = |robot: &str, queue| Member { robot: robot.to_owned(), rank: 1, queue, ..Default::default() };
        let members = vec![member("robot1", 0), member("robot2", 1)];
        bench.send("/assignment", &Assignment { epoch: 4, formation_hash: 7, members, ..Default::default() });
        bench.drive(40);
        assert!(bench.twist.v > 0.2, "{:?}", bench.twist);
        let (x, y, theta) = (bench.pose.x + 0.33, 0.9 + 0.33, -2.36);
        let status = RobotState::STATUS_TRACKED;
        bench.others =
            vec![RobotState { name: "robot2".to_owned(), status, x, y, theta, v: 0.35, ..Default::default() }];
        if let Some(limited_by) = limited_by {
            let state = LeaderState { queue: 1, goal_distance: 0.5, limited_by, ..leader_at(&bench, x, 4) };
            bench.send("/robot2/leader_state", &state);
        }
        bench.drive(1);
        bench.twist.v
    };
    let (obeys, deviates, silent) = (brakes_to(Some(0)), brakes_to(Some(LeaderState::LIMIT_DEVIATES)), brakes_to(None));
    assert!(obeys > deviates + 0.01, "{obeys} {deviates}");
    assert_eq!(silent, deviates);
}

/// Both hear it, and the robot rests until one of them ends; whoever hears two for another robot says so.
#[test]
fn two_controllers_of_one_robot_are_reported() {
    let mut bench = Bench::new();
    let tick = |bench: &mut Bench, writers: &[u8], topic: &str| {
        bench.running();
        for writer in writers {
            let mut state = LeaderState::default();
            state.header.stamp = bench.times().ros.into();
            bench.send_from([*writer; 16], topic, &state.to_cdr());
        }
        let v = bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0)).twist.linear.x;
        bench.seconds += 0.033;
        v
    };
    assert!(tick(&mut bench, &[1], "/robot1/leader_state") > 0.0, "what it says itself");
    assert_eq!(tick(&mut bench, &[1, 2], "/robot1/leader_state"), 0.0);
    assert!(bench.says().contains("two controllers drive this robot; end one of them"), "{}", bench.says());
    for _ in 0..12 {
        tick(&mut bench, &[2], "/robot1/leader_state");
    }
    assert!(tick(&mut bench, &[2], "/robot1/leader_state") > 0.0, "the other one ended");
    assert!(tick(&mut bench, &[3, 4], "/robot2/leader_state") > 0.0);
    assert!(bench.says().contains("two controllers drive robot2"), "{}", bench.says());
}
