//! Bridge and test bed together: a robot out of the base station's reach, with and without neighbours that help.

use crate::common::{Loop, Texts};
use trench_config::ParameterValue::{Bool, Double, String as Text};
use trench_msgs::msg::{LinkStatus, RunState};

/// Three robots in a line; the base station reaches the first.
const LINE: [f64; 9] = [0.5, 0.5, 0.0, 1.2, 0.5, 0.0, 1.9, 0.5, 0.0];

/// The line under way, everybody's reach 1 m.
fn line(relays: bool) -> Loop {
    let reach = |way: &'static str| (way, Double(1.0));
    let air = ["radio.reach.down", "radio.reach.up", "radio.reach.robots"].map(reach);
    let key = ("key_file", Text("key".to_owned()));
    let mut testbed = air.to_vec();
    testbed.push(key.clone());
    let files = Texts(vec![("key", "000102030405060708090a0b0c0d0e0f")]);
    let mut both = Loop::new(&LINE, &[("relays", Bool(relays)), key], &testbed, &files);
    both.run_state(RunState::RUNNING);
    both
}

#[test]
fn neighbours_pass_commands_and_reports_on() {
    let mut both = line(true);
    // The bridge learns whom it hears, who is out of reach, and by whom it is heard: one robot after the other.
    both.run(4000);
    let before: Vec<f64> = (1..=3).map(|robot| both.place(robot).0).collect();
    both.drive(60, 3, 0.06, 0.0);
    for robot in 1..=3 {
        let way = both.place(robot).0 - before[robot - 1];
        assert!((0.10..0.125).contains(&way), "robot {robot} drove {way} m");
        let link: LinkStatus = both.bridge.last(&format!("/robot{robot}/link"));
        assert!(link.up && usize::from(link.hops) == robot, "{link:?}");
    }
    // The whole line stops by the emergency stop, not by silence.
    both.emergency_stop(9, true);
    both.run(150);
    for robot in 1..=3 {
        let link: LinkStatus = both.bridge.last(&format!("/robot{robot}/link"));
        assert_eq!(link.fault & LinkStatus::FAULT_EMERGENCY_STOP, LinkStatus::FAULT_EMERGENCY_STOP, "{link:?}");
    }
}

/// Everybody hears the base station, which hears the first robot alone: those that it does not hear cannot know it but by its wish for
/// relays.
#[test]
fn who_hears_and_is_not_heard_is_passed_on_too() {
    let reach = |way: &'static str, metres: f64| (way, Double(metres));
    let air = [reach("radio.reach.down", 5.0), reach("radio.reach.up", 1.0), reach("radio.reach.robots", 1.0)];
    let mut both = Loop::new(&LINE, &[], &air, &Texts(Vec::new()));
    both.run_state(RunState::RUNNING);
    both.run(4000);
    both.drive(30, 3, 0.06, 0.0);
    for robot in 1..=3 {
        let link: LinkStatus = both.bridge.last(&format!("/robot{robot}/link"));
        assert!(link.up && usize::from(link.hops) == robot, "{link:?}");
    }
}

#[test]
fn without_them_robots_out_of_reach_rest() {
    let mut both = line(false);
    both.run(4000);
    both.drive(60, 3, 0.06, 0.0);
    assert!(both.place(1).0 > 0.6);
    assert_eq!((both.place(2).0, both.place(3).0), (1.2, 1.9));
    assert!(both.bridge.published::<LinkStatus>("/robot2/link").is_empty());
}

#[test]
fn in_reach_nobody_is_asked_to_relay() {
    let mut both = Loop::new(&LINE, &[], &[], &Texts(Vec::new()));
    both.run_state(RunState::RUNNING);
    both.drive(60, 3, 0.06, 0.0);
    let longest = both.down.iter().map(|(_, bytes)| bytes.len()).max();
    assert_eq!(longest, Some(19 + 4 * 3 + 1), "two bytes more would name relays");
    for robot in 1..=3 {
        let link: LinkStatus = both.bridge.last(&format!("/robot{robot}/link"));
        assert_eq!(link.hops, 1);
    }
}
