//! Robots at rest that turn the way their formation faces.

use crate::bench::{Bench, PERIOD, formation, make};
use trench_formation::Vector2;
use trench_formation::kinematics::Pose;
use trench_msgs::msg::{LeaderState, Point2};

const LOOK_AHEAD: f64 = 0.05;

/// A chain leader at its goal point, which looks askew; the formation faces along x.
fn askew(face: &str) -> Bench {
    let core = make(&[("team", "[robot1, robot2]"), ("law", "goal"), ("face", face)]).unwrap();
    let mut bench = Bench::of(core);
    bench.running();
    formation(&mut bench);
    bench.pose = Pose::new(1.45, 0.9, -2.5);
    let point = bench.pose.position() + LOOK_AHEAD * bench.pose.heading();
    bench.goal = Point2 { x: point.x, y: point.y };
    bench
}

/// Where the point before the axle is, and where the robot says that its law's point is.
fn points(bench: &Bench) -> [Vector2<f64>; 2] {
    let said: LeaderState = bench.out.last(bench.port("/robot1/leader_state")).unwrap();
    [bench.pose.position() + LOOK_AHEAD * bench.pose.heading(), Vector2::new(said.point.x, said.point.y)]
}

#[test]
fn a_robot_at_rest_turns_the_way_its_formation_faces_and_stands_where_it_stood() {
    for (face, turns) in [("formation", true), ("arrived", true), ("anywhere", false)] {
        let mut bench = askew(face);
        if face == "arrived" {
            bench.drive(90);
            assert_eq!(bench.pose.theta, -2.5, "the formation has not moved yet");
            bench.moves = Point2 { x: 1e-2, y: 0.0 };
            bench.drive(1);
            bench.moves = Point2::default();
        }
        let goal = Vector2::new(bench.goal.x, bench.goal.y);
        for _ in 0..450 {
            bench.drive(1);
            let [_, said] = points(&bench);
            assert!((said - goal).norm() < 0.004, "what others hear of it stays: {said:?}");
        }
        let [point, _] = points(&bench);
        assert!((point - goal).norm() < 0.004, "{face}: {point:?}");
        assert_eq!(bench.pose.theta.abs() < 0.04, turns, "{face}: {}", bench.pose.theta);
        assert_eq!(bench.last_command().twist.angular.z, 0.0, "{face}: it turns once");
    }
}

#[test]
fn a_robot_that_turns_goes_with_its_formation_at_once() {
    let mut bench = askew("formation");
    // One second at rest, and in the midst of its turns.
    bench.drive(90);
    let [point, said] = points(&bench);
    assert!((point - said).norm() > 0.02, "it is on its way: {point:?}, {said:?}");
    bench.moves = Point2 { x: 0.05, y: 0.0 };
    let mut before = said;
    for _ in 0..300 {
        bench.goal.x += bench.moves.x * PERIOD;
        bench.drive(1);
        let [_, said] = points(&bench);
        assert!((said - before).norm() < 0.2 * PERIOD, "the law's point leaps: {before:?} to {said:?}");
        before = said;
    }
    let [point, said] = points(&bench);
    assert!((point - said).norm() < 0.004, "it has caught up: {point:?}, {said:?}");
    assert!((point - Vector2::new(bench.goal.x, bench.goal.y)).norm() < 0.03, "{point:?} {:?}", bench.goal);
    assert!(bench.last_command().twist.linear.x > 0.04, "{:?}", bench.last_command());
}

#[test]
fn laws_of_chapter_4_turn_on_the_spot() {
    let core = make(&[("team", "[robot1, robot2]"), ("face", "formation")]).unwrap();
    let mut bench = Bench::of(core);
    bench.pose = Pose::new(1.5, 0.9, 2.0);
    bench.drive(300);
    assert!(bench.pose.theta.abs() < 0.04, "{:?}", bench.pose);
    assert!((bench.pose.position() - Vector2::new(1.5, 0.9)).norm() < 0.003, "{:?}", bench.pose);
}

#[test]
fn an_unknown_way_to_face_is_refused() {
    let refusal = make(&[("face", "north")]).err().unwrap();
    assert!(refusal.contains("face") && refusal.contains("write anywhere, formation or arrived"), "{refusal}");
}
