//! Formations in the frame of a target, which moves, jumps, falls silent or is a robot.

use crate::bench::{Bench, FILE, OnTarget, make_of, said};
use trench_core::Event;
use trench_msgs::Encode;
use trench_msgs::diagnostic_msgs::DiagnosticStatus;
use trench_msgs::msg::{Goals, RobotState};
use trench_msgs::nav_msgs::Odometry;

#[test]
fn a_formation_in_the_target_s_frame_moves_and_turns_with_it() {
    let core = make_of(&[FILE, ("robots", "[robot1]")], None, &OnTarget).unwrap();
    let mut bench = Bench::of(core, 10.0);
    bench.see(RobotState::STATUS_TRACKED);
    assert!(bench.last::<Goals>("/goals").is_none(), "nobody knows where the formation is");
    let mut target = Odometry::default();
    (target.pose.pose.position.x, target.pose.pose.position.y) = (1.0, 1.0);
    let quarter = std::f64::consts::FRAC_PI_4;
    (target.pose.pose.orientation.w, target.pose.pose.orientation.z) = (quarter.cos(), quarter.sin());
    (target.twist.twist.linear.x, target.twist.twist.angular.z) = (0.2, 0.1);
    let cdr = target.to_cdr();
    bench.handle(Event::Message { port: 1, source: Default::default(), cdr: &cdr, arrived: None });
    assert!(bench.call("arm").success);
    bench.see(RobotState::STATUS_TRACKED);
    let goal = bench.last::<Goals>("/goals").unwrap().goals.remove(0);
    // The target looks along y: the vertex half a metre behind it lies below it, and swings out as it turns left.
    let near =
        |value: f64, expected: f64| assert!((value - expected).abs() < 1e-9, "{value}, not {expected}: {goal:?}");
    near(goal.position.x, 1.0);
    near(goal.position.y, 0.5);
    near(goal.velocity.x, 0.05);
    near(goal.velocity.y, 0.2);
    bench.seconds += 1.0;
    bench.out.take();
    bench.see(RobotState::STATUS_TRACKED);
    assert!(bench.last::<Goals>("/goals").is_none(), "a silent target stops its formation");
}

/// The goal at a new frame, if there is one; the robot is far from everything.
fn goal_of_the_target(bench: &mut Bench, robots: &[RobotState]) -> Option<(f64, f64)> {
    bench.out.take();
    bench.see_robots([&[tracked("robot1", 3.0, 3.0)][..], robots].concat());
    bench.last::<Goals>("/goals").map(|goals| (goals.goals[0].position.x, goals.goals[0].position.y))
}

fn tracked(name: &str, x: f64, y: f64) -> RobotState {
    RobotState { name: name.to_owned(), status: RobotState::STATUS_TRACKED, x, y, ..Default::default() }
}

fn target_at(x: f64, speed: f64) -> Odometry {
    let mut target = Odometry::default();
    (target.pose.pose.position.x, target.pose.pose.orientation.w, target.twist.twist.linear.x) = (x, 1.0, speed);
    target
}

#[test]
fn a_target_that_jumps_ten_metres_is_named_and_the_formation_goes_on_and_then_stops() {
    let core = make_of(&[FILE, ("robots", "[robot1]")], None, &OnTarget).unwrap();
    let mut bench = Bench::of(core, 10.0);
    bench.see_robots(vec![tracked("robot1", 3.0, 3.0)]);
    bench.send("/target", &target_at(1.0, 0.2));
    assert!(bench.call("arm").success && bench.call("start").success);
    for tick in 1..=4 {
        bench.seconds += 0.1;
        // The believed motion goes on, half a metre ahead of the place.
        let x = 0.5 + 0.02 * f64::from(tick);
        let goal = goal_of_the_target(&mut bench, &[]).unwrap();
        assert!((goal.0 - x).abs() < 1e-9 && goal.1.abs() < 1e-9, "{goal:?}, not ({x}, 0)");
        bench.send("/target", &target_at(11.0, 0.2));
        if tick == 1 {
            let (level, text) = said(&bench, "target");
            assert_eq!(level, DiagnosticStatus::ERROR);
            assert!(text.contains("it jumped by 9.98 m, more than target.jump"), "{text}");
        }
    }
    bench.seconds += 0.2;
    bench.send("/target", &target_at(11.0, 0.2));
    assert_eq!(goal_of_the_target(&mut bench, &[]), None, "after age.target nobody knows where the formation is");
    assert!(bench.call("stop").success && bench.call("reset").success && bench.call("arm").success);
    bench.send("/target", &target_at(11.0, 0.2));
    assert_eq!(said(&bench, "target").0, DiagnosticStatus::OK);
    let goal = goal_of_the_target(&mut bench, &[]);
    assert_eq!(goal, Some((10.5, 0.0)), "the operator armed: it is believed where it is");
}

#[test]
fn a_robot_may_be_the_target() {
    let parameters = [FILE, ("robots", "[robot1]"), ("target.robot", "robot9")];
    let mut bench = Bench::of(make_of(&parameters, None, &OnTarget).unwrap(), 10.0);
    let robot9 = |y: f64, status: u8| RobotState {
        theta: std::f64::consts::FRAC_PI_2,
        v: 0.2,
        status,
        ..tracked("robot9", 1.0, y)
    };
    let seen = [robot9(1.0, RobotState::STATUS_TRACKED)];
    assert_eq!(goal_of_the_target(&mut bench, &seen), None, "not armed");
    assert!(bench.call("arm").success && bench.call("start").success);
    bench.seconds += 0.1;
    // What others say of a target counts for nothing.
    bench.send("/target", &target_at(11.0, 0.0));
    let near = |goal: Option<(f64, f64)>, y: f64| {
        let (at_x, at_y) = goal.unwrap();
        assert!((at_x - 1.0).abs() < 1e-9 && (at_y - y).abs() < 1e-9, "{goal:?}, not (1, {y})");
    };
    let seen = [robot9(1.02, RobotState::STATUS_TRACKED)];
    near(goal_of_the_target(&mut bench, &seen), 0.52);
    bench.seconds += 0.4;
    let lost = [robot9(5.0, RobotState::STATUS_LOST)];
    near(goal_of_the_target(&mut bench, &lost), 0.60);
    bench.seconds += 0.2;
    assert_eq!(goal_of_the_target(&mut bench, &lost), None, "lost for longer than age.target");
    let seen = [robot9(1.14, RobotState::STATUS_TRACKED)];
    near(goal_of_the_target(&mut bench, &seen), 0.64);
}
