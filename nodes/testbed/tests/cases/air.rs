//! Bridge and test bed together: what is wrong on the air or with a motor, and how the bridge names it.

use crate::common::{EPOCH, Loop, MS, Texts};
use trench_config::ParameterValue;
use trench_config::ParameterValue::String as Text;
use trench_core::RosTime;
use trench_msgs::Encode;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::{LinkStatus, RunState};
use trench_msgs::nav_msgs::Odometry;
use trench_msgs::sensor_msgs::BatteryState;

/// A file with a fault from the first second on.
macro_rules! fault {
    ($fault:literal) => {
        concat!("faults:\n- {from: 1.0, to: 100.0, ", $fault, "}\n")
    };
}

/// Two robots under way on a bed with these faults; with `key` their packets carry tags.
fn with_faults(faults: &'static str, key: bool) -> Loop {
    let files = Texts(vec![("faults", faults), ("key", "000102030405060708090a0b0c0d0e0f")]);
    let key = [("key_file", Text("key".to_owned()))].into_iter().filter(|_| key);
    let mut testbed = vec![("faults_file", Text("faults".to_owned()))];
    testbed.extend(key.clone());
    let bridge: Vec<_> = key.collect();
    let mut both = Loop::new(&[0.4, 0.5, 0.0, 0.4, 1.2, 0.0], &bridge, &testbed, &files);
    both.run_state(RunState::RUNNING);
    both.run(1000);
    both
}

fn says(both: &Loop, part: &str) -> String {
    let all: Vec<DiagnosticArray> = both.bridge.published("/diagnostics");
    let mut texts = all.iter().flat_map(|array| &array.status).filter(|status| status.name.ends_with(part));
    texts.next_back().map(|status| status.message.clone()).unwrap_or_default()
}

#[test]
fn nobody_without_the_key_drives_a_robot() {
    for fault in [fault!("kind: forged"), fault!("kind: replayed")] {
        let mut both = with_faults(fault, true);
        both.drive(60, 2, 0.03, 0.0);
        let way = both.place(1).0 - 0.4;
        assert!((0.045..0.065).contains(&way), "{fault}: {way} m of 0.06");
    }
    let mut open = with_faults(fault!("kind: forged"), false);
    open.drive(60, 2, 0.03, 0.0);
    assert!(open.place(1).0 - 0.4 > 0.1, "without a key robots obey anyone: the intruder is no empty threat");
}

#[test]
fn a_link_that_loses_much_is_named() {
    let mut both = with_faults(fault!("kind: corrupted"), true);
    both.drive(60, 2, 0.03, 0.0);
    assert!(says(&both, "links").contains("poor link: robot1, robot2"), "{}", says(&both, "links"));
}

/// How long after it began to be lost, ms, a third of all packets of four robots was named.
fn third_is_named_after(seed: i64) -> i64 {
    // At another time of the reports' round each.
    let begins = 2000 + 7 * seed;
    let faults = format!("faults:\n- {{from: {}, to: 100.0, kind: loss, loss: 0.3}}\n", begins as f64 * 1e-3);
    let files = Texts(vec![("faults", faults.leak())]);
    let testbed = [("faults_file", Text("faults".to_owned())), ("seed", ParameterValue::Integer(seed))];
    let poses = [0.4, 0.4, 0.0, 0.4, 0.8, 0.0, 0.4, 1.2, 0.0, 0.4, 1.6, 0.0];
    let mut both = Loop::new(&poses, &[], &testbed, &files);
    let start = (both.now / MS) as i64;
    both.run_state(RunState::RUNNING);
    both.drive(130, 4, 0.03, 0.0);
    let told: Vec<DiagnosticArray> = both.bridge.published("/diagnostics");
    let names = |text: &str| text.contains("much is lost") || text.contains("poor link");
    let first = told.iter().find(|array| array.status.iter().any(|status| names(&status.message)));
    let since_start = |array: &DiagnosticArray| (RosTime::from(&array.header.stamp).0 - EPOCH) / MS as i64 - start;
    first.map_or(i64::MAX, |array| since_start(array) - begins)
}

#[test]
fn a_third_of_all_packets_lost_is_named_within_half_a_second() {
    let mut times: Vec<i64> = (1..=40).map(third_is_named_after).collect();
    times.sort_unstable();
    // By chance more may come through at first, but never does what is usual look bad.
    assert!(times[0] > 0 && times[20] <= 350 && times[38] <= 500, "{times:?}");
}

#[test]
fn motors_that_miss_steps_are_named() {
    let mut both = with_faults(fault!("kind: missed, robots: [robot2], share: 0.5"), false);
    both.drive(60, 2, 0.06, 0.0);
    let (one, other) = (both.place(1).0 - 0.4, both.place(2).0 - 0.4);
    assert!((0.45..0.55).contains(&(other / one)), "{one} {other}");
    assert!(says(&both, "links").contains("missed steps: robot2"), "{}", says(&both, "links"));
}

#[test]
fn neighbours_carry_to_who_is_far() {
    let mut both = with_faults(fault!("kind: far, robots: [robot2]"), false);
    both.drive(60, 2, 0.03, 0.0);
    let before = both.place(2).0;
    both.drive(60, 2, 0.03, 0.0);
    assert!(both.place(2).0 > before + 0.04, "through robot1");
}

#[test]
fn whom_nobody_commands_is_named() {
    let mut both = with_faults(fault!("kind: loss, loss: 0.0"), false);
    both.drive(10, 2, 0.03, 0.0);
    assert_eq!(says(&both, "commands"), "driving");
    both.drive(15, 1, 0.03, 0.0);
    assert_eq!(says(&both, "commands"), "nobody commands: robot2");
    both.drive(15, 2, 0.03, 0.0);
    assert_eq!(says(&both, "commands"), "driving");
}

#[test]
fn reports_that_come_twice_count_once() {
    for key in [false, true] {
        let mut repeated = 0;
        let [once, twice] = [false, true].map(|twice| {
            let mut both = with_faults("faults: []\n", key);
            for _ in 0..60 {
                let before = both.testbed.outbox.actions.len();
                both.drive(1, 2, 0.03, 0.1);
                repeated += if twice { both.repeat(before) } else { 0 };
            }
            both
        });
        assert!(repeated > 20, "{repeated} frames came twice");
        for robot in ["robot1", "robot2"] {
            let odometry = |both: &Loop| both.bridge.published::<Odometry>(&format!("/{robot}/wheel_odom"));
            assert!(odometry(&once).last().unwrap().pose.pose.position.x > 0.05, "it went somewhere");
            assert_eq!(odometry(&twice), odometry(&once), "{robot}");
            // As bytes: what nobody knows of a battery is no number, which equals nothing.
            let battery = |both: &Loop| -> Vec<Vec<u8>> {
                let all = both.bridge.published::<BatteryState>(&format!("/{robot}/battery_state"));
                all.iter().map(Encode::to_cdr).collect()
            };
            assert_eq!(battery(&twice), battery(&once), "{robot}");
            let link = |both: &Loop| -> LinkStatus { both.bridge.last(&format!("/{robot}/link")) };
            let (once, twice) = (link(&once), link(&twice));
            assert!(twice.frames_rejected > 10, "{} were refused", twice.frames_rejected);
            assert_eq!(LinkStatus { frames_rejected: once.frames_rejected, ..twice }, once, "{robot}");
        }
    }
}
