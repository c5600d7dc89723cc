//! Bridge and test bed together: twists in, robots that move, and the many ways in which they must stop.

#[path = "cases/ages.rs"]
mod ages;
#[path = "cases/air.rs"]
mod air;
mod common;
#[path = "cases/hushes.rs"]
mod hushes;
#[path = "cases/relays.rs"]
mod relays;
#[path = "cases/switched.rs"]
mod switched;
#[path = "cases/turns.rs"]
mod turns;

use common::{Loop, MS, Texts, strings};
use trench_config::ParameterValue::{Bool, Double, String as Text};
use trench_core::{Action, Level, NodeContext, RosTime, Times};
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::geometry_msgs::TwistStamped;
use trench_msgs::msg::{DiscArray, LinkStatus, RunState};
use trench_msgs::nav_msgs::Odometry;
use trench_msgs::rosgraph_msgs::Clock;
use trench_msgs::sensor_msgs::{BatteryState, CameraInfo, Image, Range};
use trench_optics::{Camera, Pad, Pose2};

const NO_FILES: Texts = Texts(Vec::new());

fn two_robots() -> Loop {
    Loop::new(&[0.4, 0.5, 0.0, 0.4, 1.2, 0.0], &[], &[], &NO_FILES)
}

fn running() -> Loop {
    let mut both = two_robots();
    both.run_state(RunState::RUNNING);
    // Nobody drives before reports have said how long the way is.
    both.run(300);
    both
}

#[test]
fn commanded_speeds_appear_at_the_wheels_within_the_latency_budget() {
    let mut both = Loop::new(
        &[0.4, 0.5, 0.0],
        &[],
        &[("camera.rate", Double(100.0)), ("camera.exposure", Double(0.0)), ("radio.loss", Double(0.0))],
        &NO_FILES,
    );
    both.run_state(RunState::RUNNING);
    both.run(300);
    let sent_at = both.now;
    both.drive(15, 1, 0.07, 0.0);
    let first = both.track(1).into_iter().find(|(.., v)| *v > 0.05).unwrap();
    // 31 bytes of line (2.7 ms), at most 8 ms of air, at most 2 ms of the plant's grid, and the 10 ms of this camera.
    let latency = first.0 - sent_at as f64 / MS as f64;
    assert!((5.0..23.0).contains(&latency), "{latency} ms");
    assert!((first.3 - 0.07).abs() < 1e-4);
}

#[test]
fn the_mean_of_slow_commands_is_right() {
    let mut both = Loop::new(&[0.4, 0.5, 0.0, 0.4, 1.2, 0.0], &[], &[("radio.loss", Double(0.0))], &NO_FILES);
    both.run_state(RunState::RUNNING);
    both.drive(300, 2, 0.006, 0.0);
    both.run(200);
    for robot in [1, 2] {
        let (x, y) = both.place(robot);
        assert!((x - 0.4 - 0.006 * 10.05).abs() < 0.0012, "{x}");
        assert!((y - if robot == 1 { 0.5 } else { 1.2 }).abs() < 1e-4, "{y}");
    }
}

#[test]
fn without_dither_slow_commands_are_the_thesis_s_dead_zone() {
    let mut both = Loop::new(&[0.4, 0.5, 0.0], &[("dither", Bool(false))], &[], &NO_FILES);
    both.run_state(RunState::RUNNING);
    both.drive(60, 1, 0.0161, 0.0);
    assert_eq!(both.place(1).0, 0.4);
    both.drive(60, 1, 0.0163, 0.0);
    assert!(both.place(1).0 > 0.42);
}

#[test]
fn silence_stops_the_robots_by_themselves() {
    let mut both = running();
    both.drive(30, 2, 0.07, 0.0);
    // The last command was given 33 ms before now; the line dies with it.
    both.plug(false);
    let silent_since = both.now as f64 / MS as f64 - 34.0;
    both.run(600);
    for robot in [1, 2] {
        let moving = both.track(robot).into_iter().rfind(|(.., v)| v.abs() > 0.0).unwrap().0;
        // 3.3 ms of line, 8 ms of air, 80 ms of validity; a command may have been the last but one.
        assert!(moving - silent_since < 93.0, "still moving {} ms after the last command", moving - silent_since);
        assert!(both.place(robot).0 > 0.45);
    }
}

#[test]
fn nothing_moves_unless_the_run_state_is_running() {
    let mut both = two_robots();
    both.drive(20, 2, 0.07, 0.0);
    both.run_state(RunState::ARMED);
    both.drive(20, 2, 0.07, 0.0);
    assert_eq!(both.place(1).0, 0.4);
    both.run_state(RunState::RUNNING);
    both.drive(20, 2, 0.07, 0.0);
    let moved = both.place(1).0;
    assert!(moved > 0.42);
    both.run_state(RunState::STOPPED);
    let stopped_at = both.now as f64 / MS as f64;
    both.drive(20, 2, 0.07, 0.0);
    let moving = both.track(1).into_iter().rfind(|(.., v)| v.abs() > 0.0).unwrap().0;
    assert!(moving - stopped_at < 50.0, "{}", moving - stopped_at);
}

#[test]
fn emergency_stop_latches_until_all_agree_to_reset() {
    let mut both = running();
    both.drive(20, 2, 0.07, 0.0);
    both.emergency_stop(9, true);
    let stopped_at = both.now as f64 / MS as f64;
    both.run(150);
    let moving = both.track(1).into_iter().rfind(|(.., v)| v.abs() > 0.0).unwrap().0;
    assert!(moving - stopped_at < 15.0, "{} ms", moving - stopped_at);
    let held = (both.place(1), both.place(2));
    both.drive(40, 2, 0.07, 0.0);
    assert_eq!(held, (both.place(1), both.place(2)));
    let link: LinkStatus = both.bridge.last("/robot1/link");
    assert_eq!(link.fault & LinkStatus::FAULT_EMERGENCY_STOP, LinkStatus::FAULT_EMERGENCY_STOP);
    let refused = both.reset();
    assert!(!refused.success && refused.message.contains("still says true"), "{}", refused.message);
    both.emergency_stop(9, false);
    both.drive(20, 2, 0.07, 0.0);
    assert_eq!(held, (both.place(1), both.place(2)), "false alone does not release the stop");
    assert!(both.reset().success);
    both.drive(40, 2, 0.07, 0.0);
    assert!(both.place(1).0 > held.0.0 + 0.05 && both.place(2).0 > held.1.0 + 0.05);
}

#[test]
fn an_emergency_stop_is_repeated_to_robots_that_missed_it() {
    let mut both = Loop::new(&[0.4, 0.5, 0.0], &[], &[("radio.loss", Double(0.6))], &NO_FILES);
    both.run_state(RunState::RUNNING);
    both.drive(20, 1, 0.07, 0.0);
    both.emergency_stop(9, true);
    let stopped_at = both.now;
    both.run(1000);
    let repeats = both.down.iter().filter(|(at, bytes)| *at >= stopped_at && bytes.len() == 18).count();
    assert!((20..=22).contains(&repeats), "20 Hz for a second: {repeats}");
}

#[test]
fn heavy_loss_never_moves_a_robot_on_stale_commands() {
    let mut both = Loop::new(
        &[0.4, 0.5, 0.0, 0.4, 1.2, 0.0],
        &[],
        &[("radio.loss", Double(0.6)), ("camera.rate", Double(100.0))],
        &NO_FILES,
    );
    both.run_state(RunState::RUNNING);
    // Forwards and backwards in turn, a second of commands and a third of silence: a robot that obeyed an old packet
    // would move in the silence or the wrong way.
    let mut phases = Vec::new();
    for round in 0..12 {
        let speed = if round % 2 == 0 { 0.07 } else { -0.07 };
        phases.push((both.now as f64 / MS as f64, speed));
        both.drive(30, 2, speed, 0.0);
        phases.push((both.now as f64 / MS as f64, 0.0));
        both.run(333);
    }
    let mut moved = 0;
    for (at, _, _, v) in both.track(1).into_iter().chain(both.track(2)) {
        // What is true at `at` may have been commanded up to 95 ms before: line, air and validity.
        let admissible = |(index, (from, _)): &(usize, &(f64, f64))| {
            let until = phases.get(index + 1).map_or(f64::INFINITY, |next| next.0);
            *from <= at && at <= until + 95.0
        };
        let speeds: Vec<f64> = phases.iter().enumerate().filter(admissible).map(|(_, phase)| phase.1).collect();
        assert!(v.abs() < 1e-9 || speeds.iter().any(|speed| speed * v > 0.0), "{v} m/s at {at} ms: {speeds:?}");
        moved += usize::from(v.abs() > 0.05);
    }
    assert!(moved > 500, "with two packets in five the robots move most of the time: {moved}");
}

#[test]
fn old_commands_and_foreign_masters_are_refused() {
    let mut both = running();
    for _ in 0..10 {
        both.command(2, 0.07, 0.0, 260);
        both.run(33);
    }
    assert_eq!(both.place(1).0, 0.4);
    both.drive(10, 2, 0.07, 0.0);
    let x = both.place(1).0;
    let foreign = |now: Times| {
        let mut foreign = TwistStamped::default();
        (foreign.header.stamp, foreign.twist.linear.x) = (now.ros.into(), -0.08);
        foreign
    };
    for _ in 0..10 {
        both.publish("/robot1/cmd_vel", 77, &foreign(both.times()));
        both.command(2, 0.07, 0.0, 40);
        both.run(33);
    }
    assert!(both.place(1).0 > x + 0.015);
    both.run(600);
    let x = both.place(1).0;
    for _ in 0..10 {
        both.publish("/robot1/cmd_vel", 77, &foreign(both.times()));
        both.run(33);
    }
    assert!(both.place(1).0 < x - 0.01, "its master has gone: another may command it");
}

#[test]
fn numbers_that_are_none_never_reach_a_wheel() {
    let mut both = running();
    for v in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, 2.1] {
        both.drive(3, 2, v, 0.0);
        both.drive(3, 2, 0.0, v * 10.0);
    }
    both.run(1100);
    assert_eq!((both.place(1), both.place(2)), ((0.4, 0.5), (0.4, 1.2)));
    assert_eq!(both.logged(Level::Warn), 2, "told once a robot, counted from then on");
    let diagnostics: DiagnosticArray = both.bridge.last("/diagnostics");
    let messages = diagnostics.status.iter().find(|status| status.name.ends_with("messages")).unwrap();
    assert!(messages.values.iter().any(|value| value.key == "dropped" && value.value == "60"), "{messages:?}");
}

#[test]
fn the_port_vanishes_and_returns() {
    let mut both = running();
    both.drive(20, 2, 0.07, 0.0);
    both.plug(false);
    both.drive(60, 2, 0.07, 0.0);
    let x = both.place(1).0;
    both.plug(true);
    both.drive(30, 2, 0.07, 0.0);
    assert!(both.place(1).0 > x + 0.04);
    assert_eq!(both.logged(Level::Error), 1);
}

#[test]
fn garbage_on_the_line_is_counted_and_harmless() {
    let mut both = running();
    for round in 0..30_u8 {
        let noise: Vec<u8> = (0..97_u8).map(|byte| byte.wrapping_mul(31).wrapping_add(round)).collect();
        both.noise_up(&noise);
        both.noise_down(&noise);
        both.drive(1, 2, 0.07, 0.0);
    }
    assert!(both.place(1).0 > 0.42);
    both.run(1100);
    let diagnostics: DiagnosticArray = both.bridge.last("/diagnostics");
    let port = diagnostics.status.iter().find(|status| status.name.ends_with("serial port")).unwrap();
    assert!(port.values.iter().any(|value| value.key == "stuffing" || value.key == "checksum"), "{port:?}");
}

#[test]
fn telemetry_becomes_topics() {
    let mut both = running();
    both.drive(60, 2, 0.07, 0.0);
    both.run(300);
    let battery: BatteryState = both.bridge.last("/robot1/battery_state");
    assert!((battery.voltage - 8.2).abs() < 1e-3 && battery.percentage.is_nan());
    let wheels: Odometry = both.bridge.last("/robot2/wheel_odom");
    let travelled = both.place(2).0 - 0.4;
    assert!((wheels.pose.pose.position.x - travelled).abs() < 0.002, "{travelled}");
    // Robot 2 looks along x; robot 1 is 0.7 m to its right, 0.54 m from surface to surface.
    let right: Range = both.bridge.last("/robot2/range_3");
    assert!((right.range - 0.54).abs() < 0.011, "{}", right.range);
    let front: Range = both.bridge.last("/robot2/range_0");
    assert_eq!(front.range, f32::INFINITY);
    let link: LinkStatus = both.bridge.last("/robot1/link");
    assert!(link.up && link.hops == 1 && link.commands_sent > 55 && link.telemetry_received > 15, "{link:?}");
    assert!((0.010..0.035).contains(&link.round_trip) && link.signal < -30.0 && link.loss < 0.2, "{link:?}");
}

#[test]
fn with_a_key_only_its_owner_drives() {
    let files = Texts(vec![("key", "000102030405060708090a0b0c0d0e0f"), ("other", "ff0102030405060708090a0b0c0d0e0f")]);
    let check = |bridge: &str, moves: bool| {
        let key = |file: &str| [("key_file", Text(file.to_owned()))];
        let mut both = Loop::new(&[0.4, 0.5, 0.0], &key(bridge), &key("key"), &files);
        both.run_state(RunState::RUNNING);
        both.drive(30, 1, 0.07, 0.0);
        assert_eq!(both.place(1).0 > 0.44, moves, "{bridge:?}");
        // Replays of the whole conversation move nobody.
        both.run(500);
        let x = both.place(1).0;
        for (_, bytes) in both.down.clone() {
            both.noise_down(&bytes);
            both.run(33);
        }
        assert_eq!(both.place(1).0, x);
    };
    check("key", true);
    check("other", false);
    check("", false);
}

#[test]
fn one_frame_a_cycle_carries_all_robots() {
    let mut both = running();
    both.run(20);
    let before = both.down.len();
    both.command(1, 0.07, 0.0, 40);
    assert_eq!(both.down.len(), before + 1, "one robot is expected so far: nothing to wait for");
    both.run(20);
    both.command(2, 0.07, 0.0, 40);
    both.run(20);
    let frames: Vec<_> = both.down[before + 1..].iter().map(|(at, bytes)| (*at, bytes.len())).collect();
    // Robot 2 is new to the bridge: the frame that leaves at once tells it to stand still, its own command follows.
    assert_eq!(frames.iter().map(|frame| frame.1).collect::<Vec<_>>(), [28, 24], "{frames:?}");
    let before = both.down.len();
    both.drive(10, 2, 0.07, 0.0);
    let lengths: Vec<_> = both.down[before..].iter().map(|(_, bytes)| bytes.len()).collect();
    assert_eq!(lengths, [28; 10], "both robots in every frame");
    let (before, now) = (both.down.len(), both.now);
    both.command(1, 0.07, 0.0, 40);
    assert_eq!(both.down.len(), before, "waits for robot 2");
    both.run(5);
    assert_eq!(both.down[before].0, now + 2 * MS, "but not longer than 2 ms");
}

#[test]
fn frames_carry_detections_and_truth_with_the_stamp_of_the_exposure() {
    let mut both = two_robots();
    both.run(500);
    let discs: Vec<DiscArray> = both.testbed.published("/overhead/detections");
    let truth: Vec<Odometry> = both.testbed.published("/ground_truth/robot1/odom");
    assert_eq!((discs.len(), truth.len()), (13, 13));
    for (discs, truth) in discs.iter().zip(&truth) {
        assert_eq!((discs.header.stamp, discs.discs.len()), (truth.header.stamp, 4));
    }
}

#[test]
fn rendered_frames_show_the_pads() {
    let poses = [0.6, 0.5, 0.0, 1.6, 1.2, 2.0];
    let mut both = Loop::new(&poses, &[], &[("render", Bool(true))], &NO_FILES);
    both.run(110);
    let images: Vec<Image> = both.testbed.published("/overhead/image_raw");
    let infos: Vec<CameraInfo> = both.testbed.published("/overhead/camera_info");
    assert_eq!((images.len(), infos.len()), (2, 2));
    let image = &images[1];
    assert_eq!((image.width, image.height, image.step, image.encoding.as_str()), (768, 576, 2304, "rgb8"));
    assert_eq!((image.header.stamp, image.data.len()), (infos[1].header.stamp, 768 * 576 * 3));
    let (camera, pad) = (Camera::nominal(), Pad::NOMINAL);
    for pose in poses.chunks(3) {
        for (disc, yellow) in pad.discs(Pose2 { x: pose[0], y: pose[1], theta: pose[2] }).into_iter().zip([true, false])
        {
            let pixel = camera.project(nalgebra::Point3::new(disc.x, disc.y, pad.height)).unwrap();
            let at = 3 * (pixel.v.round() as usize * 768 + pixel.u.round() as usize);
            let [red, _, blue] = [0, 1, 2].map(|channel| i32::from(image.data[at + channel]));
            assert_eq!(red > blue + 80, yellow, "{pixel:?}: {red} {blue}");
            assert_eq!(blue > red + 80, !yellow, "{pixel:?}: {red} {blue}");
        }
    }
}

#[test]
fn an_emergency_stop_outlives_the_bridge() {
    let mut both = running();
    both.drive(10, 2, 0.07, 0.0);
    both.emergency_stop(9, true);
    let mut checkpoints = both.bridge.outbox.actions.iter().filter_map(|action| match action {
        Action::Checkpoint(bytes) => Some(bytes.clone()),
        _ => None,
    });
    let context = NodeContext { checkpoint: checkpoints.next_back(), ..NodeContext::default() };
    let description = rf_bridge::description();
    let given = [("serial.port", Text("line".to_owned())), ("robots", strings(&["robot1", "robot2"]))];
    both.bridge.core = (description.build)(&context, &common::parameters(&description, &given), &NO_FILES).unwrap();
    both.start_bridge();
    both.run_state(RunState::RUNNING);
    both.run(100);
    let place = both.place(1);
    both.drive(30, 2, 0.07, 0.0);
    assert_eq!(both.place(1), place, "still stopped");
    both.presence("/emergency_stop", 9, true);
    assert!(!both.reset().success, "who said stop to the first life is still there and has not taken it back");
    both.emergency_stop(9, false);
    assert!(both.reset().success);
    both.drive(30, 2, 0.07, 0.0);
    assert!(both.place(1).0 > place.0 + 0.04, "its packets are newer than those of the first life");
}

#[test]
fn wrong_parameters_are_refused_with_a_remedy() {
    let check = |given: &[(&str, trench_config::ParameterValue)], expected: &str| {
        let description = rf_bridge::description();
        let parameters = common::parameters(&description, given);
        let built = (description.build)(&trench_core::NodeContext::default(), &parameters, &NO_FILES);
        let error = built.err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains(expected), "{error}");
    };
    let port = ("serial.port", Text("line".to_owned()));
    check(&[], "serial.port");
    check(std::slice::from_ref(&port), "there is no robot");
    check(&[port.clone(), ("robots", strings(&["a", "a"]))], "there twice");
    check(&[port.clone(), ("robots", strings(&["a"])), ("key_file", Text("nowhere".to_owned()))], "cannot be read");
    let ids = |ids: &[i64]| ("ids", trench_config::ParameterValue::IntegerArray(ids.to_vec()));
    check(&[port.clone(), ("robots", strings(&["a", "b"])), ids(&[1])], "1 ids for 2 robots");
    check(&[port, ("robots", strings(&["a", "b"])), ids(&[4, 4])], "4 is there twice");
}

#[test]
fn its_time_is_told_with_each_frame_where_it_is_asked_for() {
    let mut both = Loop::new(&[0.4, 0.5, 0.0], &[], &[("publish_clock", Bool(true))], &NO_FILES);
    let start = both.times().ros;
    both.run(1000);
    let told: Vec<Clock> = both.testbed.published("/clock");
    let frames: Vec<CameraInfo> = both.testbed.published("/overhead/camera_info");
    assert!(frames.len() > 25 && told.len() == frames.len(), "{} times and {} frames", told.len(), frames.len());
    let times: Vec<i64> = told.iter().map(|clock| RosTime::from(&clock.clock).0).collect();
    assert!(times.is_sorted() && times[0] > start.0 && times[times.len() - 1] <= both.times().ros.0);
    for (time, frame) in times.iter().zip(&frames) {
        // A frame comes 35 ms after its exposure, at the earliest.
        let age = (time - RosTime::from(&frame.header.stamp).0) / MS as i64;
        assert!((35..70).contains(&age), "{age} ms");
    }
    let silent = Loop::new(&[0.4, 0.5, 0.0], &[], &[], &NO_FILES);
    assert!(silent.testbed.core.interface().publications.iter().all(|topic| topic.topic != "/clock"));
}
