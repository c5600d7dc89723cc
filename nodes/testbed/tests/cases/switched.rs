//! Bridge and test bed together: robots that are switched off and on, two radios of one id, and no key at all.

use crate::common::{EPOCH, Loop, MS, Texts};
use trench_config::ParameterValue::String as Text;
use trench_core::{Action, Level, RosTime};
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::{LinkStatus, RunState};
use trench_msgs::nav_msgs::Odometry;

const KEY: &str = "000102030405060708090a0b0c0d0e0f";

/// Three robots under way with these faults; all with a key, or none.
fn with(faults: &'static str, key: bool) -> Loop {
    let files = Texts(vec![("faults", faults), ("key", KEY)]);
    let bridge: Vec<_> = [("key_file", Text("key".to_owned()))].into_iter().filter(|_| key).collect();
    let mut testbed = vec![("faults_file", Text("faults".to_owned()))];
    testbed.extend(bridge.clone());
    let mut both = Loop::new(&[0.4, 0.3, 0.0, 0.4, 0.9, 0.0, 0.4, 1.5, 0.0], &bridge, &testbed, &files);
    both.run_state(RunState::RUNNING);
    both
}

/// When links were first said to be so, ms after the start, if ever.
fn named_at(both: &Loop, start: u64, part: &str) -> Option<i64> {
    let all: Vec<DiagnosticArray> = both.bridge.published("/diagnostics");
    let says = |array: &&DiagnosticArray| {
        array.status.iter().any(|status| status.name.ends_with("links") && status.message.contains(part))
    };
    let since =
        |array: &DiagnosticArray| (RosTime::from(&array.header.stamp).0 - EPOCH) / MS as i64 - (start / MS) as i64;
    all.iter().find(says).map(since)
}

fn ways(both: &mut Loop, frames: u64) -> [f64; 3] {
    let before = [1, 2, 3].map(|robot| both.place(robot).0);
    both.drive(frames, 3, 0.03, 0.0);
    let after = [1, 2, 3].map(|robot| both.place(robot).0);
    std::array::from_fn(|robot| after[robot] - before[robot])
}

#[test]
fn robots_with_a_key_start_as_soon_as_those_without() {
    let [open, keyed] = [false, true].map(|key| {
        let mut both = with("faults: []\n", key);
        both.drive(30, 3, 0.03, 0.0);
        [1, 2, 3].map(|robot| both.place(robot).0 - 0.4)
    });
    for robot in 0..3 {
        // A round until its first slot, of 30 mm/s.
        assert!(open[robot] - keyed[robot] < 0.0045 && keyed[robot] > 0.02, "{open:?} {keyed:?}");
    }
}

#[test]
fn a_robot_that_is_switched_off_and_on_is_named_and_goes_on() {
    for key in [true, false] {
        let mut both = with("faults:\n- {kind: switched_off, from: 2.0, to: 4.0, robots: [robot2]}\n", key);
        let start = both.now;
        both.drive(60, 3, 0.03, 0.0);
        assert_eq!(named_at(&both, start, "switched on anew"), None);
        let [one, two, three] = ways(&mut both, 60);
        assert!(one > 0.05 && three > 0.05 && two < 0.005, "{one} {two} {three}");
        let [one, two, three] = ways(&mut both, 60);
        assert!(one > 0.05 && three > 0.05 && two > 0.05, "{one} {two} {three}");
        let named = named_at(&both, start, "switched on anew: robot2");
        assert!(named.is_some_and(|ms| (4000..4500).contains(&ms)), "{named:?}");
        assert_eq!(named_at(&both, start, "two radios"), None, "it is one");
        both.drive(60, 3, 0.03, 0.0);
        let last: DiagnosticArray = both.bridge.last("/diagnostics");
        assert!(last.status.iter().all(|status| !status.message.contains("anew")), "it is told for two seconds");
    }
}

/// While the base says nothing to robot2, somebody plays all that it said before.
#[test]
fn what_was_recorded_drives_no_robot_that_is_switched_on() {
    let faults = "faults:\n- {kind: switched_off, from: 2.0, to: 2.5, robots: [robot2]}\n- {kind: recorded, from: 2.0, to: 5.0}\n";
    let mut both = with(faults, true);
    both.drive(60, 3, 0.03, 0.0);
    // The team stands: whoever moves obeys a record.
    let before = [1, 2, 3].map(|robot| both.place(robot).0);
    both.drive(75, 3, 0.0, 0.0);
    for robot in 1..=3 {
        assert!((both.place(robot).0 - before[robot - 1]).abs() < 0.004, "robot{robot}");
    }
    let [one, two, three] = ways(&mut both, 30);
    assert!(one > 0.025 && two > 0.025 && three > 0.025, "{one} {two} {three}");
}

#[test]
fn a_bridge_that_is_killed_welcomes_nobody_anew() {
    let mut both = with("faults: []\n", true);
    both.drive(60, 3, 0.03, 0.0);
    let downs = both.down.len();
    both.start_bridge();
    both.run_state(RunState::RUNNING);
    let [one, two, three] = ways(&mut both, 30);
    assert!(one > 0.025 && two > 0.025 && three > 0.025, "{one} {two} {three}");
    assert!(both.down[downs..].iter().all(|(_, line)| !is_welcome(line)), "they go on with what they know");
    assert!(both.down[..downs].iter().any(|(_, line)| is_welcome(line)));
}

fn is_welcome(line: &[u8]) -> bool {
    let mut found = false;
    trench_radio::StreamDecoder::default().push(line, |frame| {
        let trench_radio::LinkFrame::Downlink { packet } = frame else { return };
        let packet = trench_radio::Packet::decode(packet, None);
        found |= packet.is_ok_and(|packet| matches!(packet.payload, trench_radio::Payload::Welcome(_)));
    });
    found
}

#[test]
fn an_emergency_stop_holds_robots_that_are_switched_on_meanwhile() {
    let mut both = with("faults:\n- {kind: switched_off, from: 2.0, to: 3.0, robots: [robot2]}\n", true);
    both.drive(60, 3, 0.03, 0.0);
    both.emergency_stop(9, true);
    both.drive(30, 3, 0.03, 0.0);
    assert!(ways(&mut both, 60).iter().all(|way| way.abs() < 1e-6));
    let link: LinkStatus = both.bridge.last("/robot2/link");
    assert_eq!(link.fault & LinkStatus::FAULT_EMERGENCY_STOP, LinkStatus::FAULT_EMERGENCY_STOP);
    both.emergency_stop(9, false);
    assert!(both.reset().success);
    both.run(100);
    assert!(ways(&mut both, 30).iter().all(|way| *way > 0.025));
}

#[test]
fn two_radios_of_one_id_are_named_and_stand() {
    for key in [true, false] {
        let faults = "faults:\n- {kind: doubled, robot: robot3, like: robot2, from: 2.0, to: 5.0}\n\
            - {kind: switched_off, from: 6.0, to: 6.5, robots: [robot2]}\n";
        let mut both = with(faults, key);
        let start = both.now;
        both.drive(60, 3, 0.03, 0.0);
        both.drive(25, 3, 0.03, 0.0);
        let named = named_at(&both, start, "two radios answer as robot2");
        assert!(named.is_some_and(|ms| (2000..2500).contains(&ms)), "{named:?}");
        let odometry = |both: &Loop| both.bridge.published::<Odometry>("/robot2/wheel_odom").len();
        let reports = odometry(&both);
        let [one, two, three] = ways(&mut both, 45);
        assert!(one > 0.035 && two.abs() < 0.001 && three.abs() < 0.001, "{one} {two} {three}");
        let link: LinkStatus = both.bridge.last("/robot2/link");
        assert!(!link.up);
        assert_eq!(odometry(&both), reports, "whose steps they are nobody knows");
        // Robot 3 is itself again. Under a key robot 2 must be switched off and on: the other radio's counters were higher.
        both.drive(45, 3, 0.03, 0.0);
        let link: LinkStatus = both.bridge.last("/robot2/link");
        assert!(!link.up);
        both.drive(60, 3, 0.03, 0.0);
        assert!(ways(&mut both, 30).iter().all(|way| *way > 0.025), "{key}");
        let link: LinkStatus = both.bridge.last("/robot2/link");
        assert!(link.up && odometry(&both) > reports);
    }
}

#[test]
fn a_bridge_without_a_key_says_what_that_means_once() {
    let told = |both: &Loop| -> Vec<String> {
        let of = |action: &Action| match action {
            Action::Log { level: Level::Info, text, .. } if text.contains("key") => Some(text.clone()),
            _ => None,
        };
        both.bridge.outbox.actions.iter().filter_map(of).collect()
    };
    let value = |both: &Loop| -> String {
        let last: DiagnosticArray = both.bridge.last("/diagnostics");
        let links = last.status.into_iter().find(|status| status.name.ends_with("links")).unwrap();
        links.values.into_iter().find(|value| value.key == "key").unwrap().value
    };
    let mut open = with("faults: []\n", false);
    open.drive(60, 3, 0.03, 0.0);
    let said = told(&open);
    assert!(said.len() == 1 && said[0].contains("anybody") && said[0].contains("openssl rand"), "{said:?}");
    assert!(value(&open).contains("anybody on the channel can drive"));
    let mut keyed = with("faults: []\n", true);
    keyed.drive(60, 3, 0.03, 0.0);
    assert_eq!((told(&keyed), value(&keyed)), (vec![], "in force".to_owned()));
}
