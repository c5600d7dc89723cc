//! Services, the emergency stop, and strangers on our topics.

use crate::TEAM_STATE;
use crate::support::{Follower, Island, Launch, Moment, Publisher, number};

/// m/s: slower wheels are at rest, as the vision sees them.
const REST: f64 = 0.02;

/// m: what a robot at rest may seem to move.
const STILL: f64 = 0.005;

#[test]
fn interop_rclpy_operates_and_stops_the_robots() {
    let island = Island::new(3);
    let launch = Launch::start(&island, "tests/interop/square.launch.yaml", &[]);
    let team = island.follow(TEAM_STATE);
    team.until("four robots are tracked", |message| {
        let robots = message["robots"].as_array().unwrap();
        robots.len() == 4 && robots.iter().all(|robot| robot["status"] == 1)
    });
    // The bridge and four controllers hear it. It is there before it is needed: a reliable writer of Fast DDS repeats
    // what a reader missed while they met only after 3 s.
    let button = island.publisher("/emergency_stop std_msgs/msg/Bool --subscribers 5");
    let assignment = |service: &str| call(&island, &format!("/leader_assignment/{service}"));
    assert_eq!(assignment("start"), (false, "cannot start: the run is idle, it must be armed (call arm first)".into()));
    assert!(assignment("arm").0);
    assert!(assignment("start").0);
    emergency_stop_holds_until_reset(&island, &team, button);
    foreign_messages_do_not_lead_astray(&island, &team, &launch);
    assert!(assignment("stop").0);
    assert_eq!(assignment("arm"), (false, "cannot arm: the run is stopped, it must be idle (call reset first)".into()));
    assert!(assignment("reset").0);
    assert!(assignment("arm").0);
    let run = island.latched("/run_state trench_msgs/msg/RunState");
    assert_eq!(run["state"], 1, "armed: {run}");
    let (code, said) = launch.interrupt();
    assert_eq!(code, Some(0), "{said}");
}

/// Success and message of a Trigger.
fn call(island: &Island, service: &str) -> (bool, String) {
    let answer = island.ask("peer_service.py", service);
    (answer["success"].as_bool().unwrap(), answer["message"].as_str().unwrap().to_owned())
}

fn emergency_stop_holds_until_reset(island: &Island, team: &Follower, mut button: Publisher) {
    team.until("the robots drive", |message| Moment::of(message).fastest() > 0.05);
    let pressed = button.say(r#"{"data": true}"#);
    let moments: Vec<Moment> = team.during(2.0).iter().map(Moment::of).collect();
    let late: Vec<&Moment> = moments.iter().filter(|moment| moment.time >= pressed + 0.5).collect();
    assert!(late.len() > 20, "{} frames", late.len());
    let speeds: Vec<_> = moments.iter().map(|moment| (moment.time - pressed, moment.fastest())).collect();
    assert!(late.iter().all(|moment| moment.fastest() < REST), "(s after the stop, m/s): {speeds:.3?}");
    let (success, reason) = call(island, "/rf_bridge/reset");
    assert!(!success && reason.contains("a publisher of /emergency_stop still says true"), "{reason}");
    button.say(r#"{"data": false}"#);
    for moment in team.during(2.0).iter().map(Moment::of) {
        assert!(moment.fastest() < REST, "no word but the reset's ends it: {moment:?}");
        assert!(moment.moved_since(late[0]) < STILL, "{moment:?} after {late:?}");
    }
    assert_eq!(call(island, "/rf_bridge/reset"), (true, "the robots obey commands again".into()));
    team.until("the robots drive again", |message| Moment::of(message).fastest() > 0.03);
}

fn foreign_messages_do_not_lead_astray(island: &Island, team: &Follower, launch: &Launch) {
    let log = island.follow("/rosout rcl_interfaces/msg/Log --qos reliable,transient_local,1000");
    let diagnostics = island.follow("/diagnostics diagnostic_msgs/msg/DiagnosticArray --qos reliable,volatile,100");
    let diagnosed = |text: &str| {
        diagnostics.until(text, |message| {
            let mut parts = message["status"].as_array().unwrap().iter();
            parts.any(|part| part["message"].as_str().unwrap().contains(text))
        });
    };
    // A foreign type on a topic is told and has no effect.
    let mut text = island.publisher("/goals std_msgs/msg/String --subscribers 0 --rate 30");
    text.say(r#"{"data": "go home"}"#);
    let foreign = "/goals: another process writes std_msgs/msg/String there";
    log.until(foreign, |line| line["msg"].as_str().unwrap().contains(foreign));
    // A second publisher of commands, nonsense or not, is not obeyed.
    let mut commands = island.publisher("/robot1/cmd_vel geometry_msgs/msg/TwistStamped --rate 60 --stamp");
    commands.say(r#"{"twist": {"linear": {"x": NaN}, "angular": {"z": Infinity}}}"#);
    diagnosed("a command for robot1 was dropped: another publisher commands this robot");
    commands.say(r#"{"twist": {"linear": {"x": -0.25}, "angular": {"z": 3.0}}}"#);
    // Poses are the localizer's: a second publisher is not believed, nonsense or not.
    let mut poses = island.publisher("/team_state trench_msgs/msg/TeamState --rate 15 --stamp");
    poses.say(&nowhere());
    diagnosed("/team_state was dropped: another publisher writes this topic");
    drop(poses);
    let mut obstacles = island.publisher("/obstacles trench_msgs/msg/ObstacleArray");
    obstacles.say(r#"{"obstacles": [{"id": 7, "radius": 0.1, "polygon": [{"x": NaN, "y": 0.5}]}]}"#);
    diagnosed("obstacle 7 is left out");
    // And so all come to their places.
    let goals = island.follow("/goals trench_msgs/msg/Goals");
    goals.until("the points rest", |message| message["goals"][0]["phase"] == 2);
    for robot in 1..=4 {
        let state = island.follow(&format!("/robot{robot}/leader_state trench_msgs/msg/LeaderState"));
        state.until("the robot is at its vertex", |message| number(message, "/goal_distance") < 0.01);
    }
    let before = Moment::of(&team.during(0.5)[0]);
    let mut poses = island.publisher("/team_state trench_msgs/msg/TeamState --rate 15 --stamp");
    poses.say(&nowhere());
    // Ours alone count frames.
    for message in team.during(2.0).iter().filter(|message| message["frame_number"] != 0) {
        assert!(Moment::of(message).moved_since(&before) < 2.0 * STILL, "{message} after {before:?}");
    }
    assert!(!launch.said().contains("process has died"), "{}", launch.said());
}

/// A team state without a place for anyone.
fn nowhere() -> String {
    let robot =
        |number: usize| format!(r#"{{"name": "robot{number}", "status": 1, "x": NaN, "y": NaN, "theta": NaN}}"#);
    let robots: Vec<String> = (1..=4).map(robot).collect();
    format!(r#"{{"robots": [{}]}}"#, robots.join(", "))
}
