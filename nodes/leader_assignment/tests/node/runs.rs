//! Runs from arm to stop, and those that outlive a process.

use crate::bench::{Bench, FILE, ROBOTS, make, said};
use trench_core::{Event, RosTime};
use trench_msgs::msg::{Assignment, Goal, Goals, RobotState, RunState, TeamState};
use trench_msgs::visualization_msgs::MarkerArray;

#[test]
fn a_run_from_arm_to_stop() {
    let mut bench = Bench::running();
    let state: RunState = bench.last("/run_state").unwrap();
    assert_eq!((state.state, RosTime::from(&state.t0)), (RunState::RUNNING, RosTime(101_000_000_000)));
    let goals: Goals = bench.last("/goals").unwrap();
    assert_eq!(goals.goals.len(), 4);
    assert!(goals.goals.iter().all(|goal| goal.phase == Goal::PHASE_APPROACH));
    bench.seconds += 9.0;
    bench.see(RobotState::STATUS_TRACKED);
    let goals: Goals = bench.last("/goals").unwrap();
    assert!(goals.goals.iter().all(|goal| goal.phase == Goal::PHASE_MOVING && goal.velocity.x > 0.06));
    assert!(bench.call("stop").success);
    let state: RunState = bench.last("/run_state").unwrap();
    assert_eq!(state.state, RunState::STOPPED);
}

#[test]
fn viewers_are_shown_the_formation_and_who_follows_whom() {
    let mut bench = Bench::new(100.0, None);
    bench.see(RobotState::STATUS_TRACKED);
    let shown = |bench: &Bench| -> Vec<(String, usize)> {
        let markers = bench.last::<MarkerArray>("/markers").unwrap().markers;
        assert!(markers.iter().all(|marker| marker.header.frame_id == "map" && marker.lifetime.sec > 0));
        markers.into_iter().map(|marker| (marker.ns, marker.points.len())).collect()
    };
    let queues = ["formation/segments", "formation/vertices"].repeat(2);
    let queues: Vec<_> = queues.into_iter().map(|namespace| (namespace.to_owned(), 2)).collect();
    assert_eq!(shown(&bench), queues, "before anyone is assigned");
    let bench = Bench::running();
    let goals = ("formation/goals".to_owned(), 4);
    let arrow = ("formation/leaders".to_owned(), 2);
    assert_eq!(shown(&bench), [queues, vec![goals, arrow.clone(), arrow]].concat());
}

#[test]
fn nobody_arms_robots_that_are_not_seen() {
    let mut bench = Bench::new(100.0, None);
    let refused = bench.call("arm");
    assert!(!refused.success && refused.message.contains("no /team_state"), "{refused:?}");
    bench.see(RobotState::STATUS_LOST);
    let refused = bench.call("arm");
    assert_eq!(refused.message, "not localised: robot1, robot2, robot3, robot4");
}

/// A stranger who speaks before the localizer does, of what nobody can have seen, neither begins a run nor has its place.
#[test]
fn who_tells_of_another_time_takes_nobodys_place() {
    for stamp in [7200.0, 1.0] {
        let mut bench = Bench::new(100.0, None);
        for _ in 0..10 {
            let mut team = TeamState::default();
            team.header.stamp = RosTime(0).plus_seconds(stamp).into();
            bench.send_from([9; 16], "/team_state", &team);
            assert_eq!(bench.last::<RunState>("/run_state").map_or(RosTime(0), |run| (&run.t0).into()), RosTime(0));
            bench.seconds += 0.02;
        }
        bench.see(RobotState::STATUS_TRACKED);
        let armed = bench.call("arm");
        assert!(armed.success, "{stamp}: {armed:?}");
    }
}

#[test]
fn a_team_state_with_numbers_that_are_none_is_said_and_dropped() {
    for (bad, field) in [f64::NAN, f64::NEG_INFINITY].into_iter().flat_map(|bad| (0..5).map(move |field| (bad, field)))
    {
        let mut bench = Bench::running();
        bench.see(RobotState::STATUS_TRACKED);
        let before: Goals = bench.last("/goals").unwrap();
        bench.seconds += 0.1;
        let mut robot = RobotState { name: "robot1".to_owned(), status: 1, ..RobotState::default() };
        *[&mut robot.x, &mut robot.y, &mut robot.theta, &mut robot.v, &mut robot.omega][field] = bad;
        bench.see_robots(vec![robot]);
        assert_eq!(bench.last::<Goals>("/goals").unwrap(), before, "no goals of it");
        let (_, text) = said(&bench, "messages");
        assert!(text.contains("a message on /team_state was dropped: a number in it is not finite"), "{text}");
        bench.see(RobotState::STATUS_TRACKED);
        let after: Goals = bench.last("/goals").unwrap();
        assert!(after.goals.len() == 4 && after.is_finite() && after != before, "{bad} in field {field}");
    }
}

#[test]
fn a_process_that_died_goes_on_where_it_was() {
    let mut died = Bench::running();
    let before: Assignment = {
        died.see(RobotState::STATUS_TRACKED);
        let mut again = Bench::new(104.0, Some(died.checkpoint()));
        again.see(RobotState::STATUS_TRACKED);
        let state: RunState = again.last("/run_state").unwrap();
        assert_eq!((state.state, RosTime::from(&state.t0)), (RunState::RUNNING, RosTime(101_000_000_000)));
        assert_eq!(again.last::<Goals>("/goals").unwrap().goals.len(), 4);
        again.last("/assignment").unwrap()
    };
    assert_eq!((before.epoch, before.members.len()), (1, 4));
}

#[test]
fn yesterday_s_run_does_not_go_on() {
    let state = |bench: &Bench| bench.last::<RunState>("/run_state").unwrap().state;
    let died = Bench::running();
    assert_eq!(state(&Bench::new(3600.0, Some(died.checkpoint()))), RunState::IDLE, "too old");
    assert_eq!(state(&Bench::new(50.0, Some(died.checkpoint()))), RunState::IDLE, "from the future");
    let mut ended = Bench::running();
    ended.handle(Event::Shutdown);
    assert_eq!(state(&ended), RunState::STOPPED, "nobody goes on by the word of who has ended");
    assert_eq!(state(&Bench::new(102.0, Some(ended.checkpoint()))), RunState::IDLE, "it ended cleanly");
    assert_eq!(state(&Bench::new(102.0, Some(vec![1, 2, 3]))), RunState::IDLE, "damaged");
}

#[test]
fn what_cannot_be_is_refused_at_start() {
    let refused = |overrides: &[(&str, &str)]| make(overrides, None).map(drop).unwrap_err();
    assert!(refused(&[ROBOTS]).contains("no formation is given"));
    assert!(refused(&[FILE]).contains("there is no robot"));
    let order = refused(&[FILE, ROBOTS, ("chain.order", "nearest_first")]);
    assert!(order.contains("chain.order") && order.contains("write nearest or places"), "{order}");
    let five = ("robots", "[a, b, c, d, e]");
    assert!(refused(&[FILE, five]).contains("5 robots, but the formation square has 4 places"));
    let twice = ("robots", "[robot1, robot2, robot1]");
    assert!(refused(&[FILE, twice]).contains("robot1 is there twice; name each robot once"));
    assert!(refused(&[("formation_file", "nowhere.yaml"), ROBOTS]).contains("formation_file"));
}
