//! Robots that quit, join, and hear each other or not.

use crate::bench::Bench;
use trench_core::Event;
use trench_msgs::msg::{Assignment, Goals};

const EVERYBODY: [(&str, &[&str]); 4] =
    [("robot1", &["robot2"]), ("robot2", &["robot1"]), ("robot3", &["robot4"]), ("robot4", &["robot3"])];

fn names(pairs: &[(&str, &str)]) -> Vec<(String, String)> {
    pairs.iter().map(|(robot, leader)| ((*robot).to_owned(), (*leader).to_owned())).collect()
}

#[test]
fn who_does_not_hear_its_leader_follows_nobody_until_it_does() {
    let mut bench = Bench::running();
    bench.live(5.0, &EVERYBODY, &[]);
    let whole = names(&[("robot2", ""), ("robot1", "robot2"), ("robot4", ""), ("robot3", "robot4")]);
    assert_eq!(bench.chains(), whole);
    let deaf: [(&str, &[&str]); 4] = [("robot1", &["robot3"]), EVERYBODY[1], EVERYBODY[2], EVERYBODY[3]];
    bench.live(0.4, &deaf, &[]);
    assert_eq!(bench.chains(), whole, "a gap is no break");
    bench.live(0.5, &deaf, &[]);
    let broken = names(&[("robot2", ""), ("robot1", ""), ("robot4", ""), ("robot3", "robot4")]);
    assert_eq!(bench.chains(), broken);
    bench.live(1.2, &EVERYBODY, &[]);
    assert_eq!(bench.chains(), broken, "the dwell time is not over");
    bench.live(1.0, &EVERYBODY, &[]);
    assert_eq!(bench.chains(), whole);
    let goals: Goals = bench.last("/goals").unwrap();
    let assignment: Assignment = bench.last("/assignment").unwrap();
    assert_eq!((goals.epoch, assignment.epoch), (3, 3));
}

#[test]
fn robots_quit_and_join_while_the_others_keep_their_places() {
    let mut bench = Bench::running();
    bench.live(5.0, &EVERYBODY, &[]);
    let before = bench.assigned();
    bench.live(2.5, &EVERYBODY, &["robot2"]);
    let three = names(&[("robot1", ""), ("robot4", ""), ("robot3", "robot4")]);
    assert_eq!(bench.chains(), three, "robot2's radio is down");
    assert_eq!(bench.last::<Goals>("/goals").unwrap().goals.len(), 3);
    // A controller that dies is no other case.
    bench.live(3.0, &[EVERYBODY[0], EVERYBODY[1], EVERYBODY[3]], &["robot2"]);
    assert_eq!(bench.chains(), names(&[("robot1", ""), ("robot4", "")]));
    bench.live(3.0, &EVERYBODY, &[]);
    let after: Assignment = bench.last("/assignment").unwrap();
    assert_eq!(after.members, before.members, "both have their places again");
}

#[test]
fn while_the_localizer_is_silent_nobody_has_quit() {
    let mut bench = Bench::running();
    bench.live(5.0, &EVERYBODY, &[]);
    let before = bench.assigned();
    for _ in 0..50 {
        bench.seconds += 0.1;
        bench.speak(&EVERYBODY, &[]);
        bench.handle(Event::Wakeup);
    }
    bench.live(1.0, &EVERYBODY, &[]);
    assert_eq!(bench.assigned(), before, "places and epoch are as they were");
    for _ in 0..50 {
        bench.seconds += 0.1;
        bench.speak(&EVERYBODY[1..], &[]);
        bench.handle(Event::Wakeup);
    }
    assert_eq!(bench.chains().len(), 3, "a controller that dies meanwhile is missed");
}

#[test]
fn a_robot_that_has_quit_joins_after_a_restart_too() {
    let mut died = Bench::running();
    died.live(5.0, &EVERYBODY, &[]);
    died.live(2.5, &EVERYBODY, &["robot2"]);
    died.seconds += 1.0;
    died.handle(Event::Wakeup);
    let mut again = Bench::new(died.seconds + 1.0, Some(died.checkpoint()));
    assert_eq!(again.chains().len(), 3);
    again.live(1.0, &EVERYBODY, &[]);
    assert_eq!(again.chains().len(), 4, "{:?}", again.chains());
}
