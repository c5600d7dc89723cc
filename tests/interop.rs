//! Real ROS 2 against our processes: rclpy with Fast DDS (scripts/ros-venv) sees, decodes, sets and stops the launched
//! square.

#![expect(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its support too")]

mod interop_support;

use interop_support::{Follower, Island, Launch, Moment, Publisher, graph, number, stamp};
use serde_json::{Value, json};
use std::collections::BTreeMap;

const TEAM_STATE: &str = "/team_state trench_msgs/msg/TeamState --qos reliable,volatile,10";

/// m/s: slower wheels are at rest, as the vision sees them.
const REST: f64 = 0.02;

/// m: what a robot at rest may seem to move.
const STILL: f64 = 0.005;

#[test]
fn interop_peers_understand_each_other() {
    let island = Island::new(0);
    let peers = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/interop/test_peers.sh");
    let status = island.in_venv(island.command(peers)).status().unwrap();
    assert!(status.success(), "the venv is broken: the tests below prove nothing");
}

#[test]
fn interop_type_hashes_are_those_of_ros() {
    let ours: BTreeMap<&str, &str> = trench_msgs::types().iter().map(|info| (info.name, info.hash)).collect();
    let mut packages: Vec<&str> = ours.keys().filter_map(|name| name.split('/').next()).collect();
    packages.dedup();
    // Packages that come in no wheel. The reference hashes of trench_msgs's own tests have tf2_msgs.
    let absent = ["tf2_msgs", "rosbag2_interfaces"];
    packages.retain(|package| !absent.contains(package));
    let island = Island::new(1);
    let output = island.python("type_hashes.py").args(&packages).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let theirs: BTreeMap<String, String> = serde_json::from_slice(&output.stdout).unwrap();
    let is_absent = |name: &str| absent.iter().any(|package| name.split('/').next() == Some(*package));
    for (name, hash) in ours.iter().filter(|(name, _)| !is_absent(name)) {
        assert_eq!(theirs.get(*name).map(String::as_str), Some(*hash), "{name}");
    }
    let custom = theirs.keys().filter(|name| name.starts_with("trench_msgs/msg/"));
    assert_eq!(custom.count(), ours.keys().filter(|name| name.starts_with("trench_msgs/msg/")).count());
}

#[test]
fn interop_rclpy_sees_decodes_and_sets_the_launched_square() {
    let island = Island::new(2);
    let launch = Launch::start(&island, "launch/square.launch.yaml", &["duration:=600.0"]);
    let ready = "--wait-for /operator --wait-for /team_state --wait-for /robot1/formation_controller --settle 3";
    graph::check(&island.ask("peer_graph.py", ready));
    let team = island.follow(TEAM_STATE);
    team.until("the robots drive", |message| Moment::of(message).slowest() > 0.03);
    team_state_is_sensible(&team.during(2.0));
    late_joiners_get_latched_topics(&island);
    messages_decode(&island);
    parameter_services_work(&island);
    let (code, said) = launch.interrupt();
    // 130: interrupted before the operator's verdict.
    assert_eq!(code, Some(130), "{said}");
    assert_eq!(said.matches("process has finished cleanly").count(), 10, "{said}");
}

/// What every node of the square has, when nothing changes any more.
fn nodes_of_the_square(island: &Island, together: bool) -> Value {
    let argument = format!("together:={together}");
    let _launch = Launch::start(island, "launch/square.launch.yaml", &["duration:=600.0", &argument]);
    let robots = (1..=4).map(|robot| format!(" --wait-for /robot{robot}/formation_controller"));
    let ready = format!("--wait-for /operator --wait-for /rf_bridge --settle 8{}", robots.collect::<String>());
    island.ask("peer_nodes.py", &ready)
}

#[test]
fn interop_controllers_in_one_process_have_the_same_graph() {
    let island = Island::new(0);
    let separate = nodes_of_the_square(&island, false);
    let together = nodes_of_the_square(&island, true);
    assert_eq!(separate.as_object().unwrap().len(), 10, "{separate:#}");
    let topics = separate["/robot2/formation_controller"]["subscriber"].as_object().unwrap();
    assert!(topics.contains_key("/robot1/leader_state") && topics.contains_key("/team_state"), "{topics:?}");
    assert_eq!(separate, together);
}

fn team_state_is_sensible(messages: &[Value]) {
    assert!(messages.len() > 30, "{} messages in 2 s at 30 Hz", messages.len());
    for pair in messages.windows(2) {
        let step = number(&pair[1], "/frame_number") - number(&pair[0], "/frame_number");
        assert!(step >= 1.0 && (stamp(&pair[1]) - stamp(&pair[0]) - step / 30.0).abs() < 1e-3, "{pair:?}");
    }
    let last = &messages[messages.len() - 1];
    assert_eq!(last["header"]["frame_id"], "map");
    let robots = last["robots"].as_array().unwrap();
    let names: Vec<&str> = robots.iter().filter_map(|robot| robot["name"].as_str()).collect();
    assert_eq!(names, ["robot1", "robot2", "robot3", "robot4"]);
    for robot in robots {
        assert_eq!(robot["status"], 1, "tracked: {robot}");
        let (x, y) = (number(robot, "/x"), number(robot, "/y"));
        assert!((0.0..2.48).contains(&x) && (0.0..1.83).contains(&y), "on the field: {robot}");
        let variances = [0, 4, 8].map(|index| number(robot, &format!("/pose_covariance/{index}")));
        assert!(variances.iter().all(|variance| *variance > 0.0 && *variance < 1e-4), "{robot}");
    }
}

fn late_joiners_get_latched_topics(island: &Island) {
    let latched = |topic: &str| {
        let answer = island.ask("peer_echo.py", &format!("{topic} --qos reliable,transient_local,1"));
        answer["messages"][0].clone()
    };
    let formation = latched("/formation trench_msgs/msg/Formation");
    assert_eq!((&formation["name"], &formation["header"]["frame_id"]), (&json!("square"), &json!("map")));
    assert_eq!(formation["queues"][1]["vertices"][1], json!({"x": 2.075, "y": 1.3}));
    let assignment = latched("/assignment trench_msgs/msg/Assignment");
    assert_eq!(assignment["formation_hash"], formation["hash"]);
    assert_eq!(assignment["members"].as_array().unwrap().len(), 4);
    let run = latched("/run_state trench_msgs/msg/RunState");
    assert_eq!((&run["state"], &run["epoch"]), (&json!(2), &assignment["epoch"]), "running: {run}");
    let lines =
        island.ask("peer_echo.py", "/rosout rcl_interfaces/msg/Log --qos reliable,transient_local,100 --count 5");
    let lines = lines["messages"].as_array().unwrap();
    assert!(lines.iter().all(|line| line["level"].as_u64() >= Some(20) && line["name"] != ""), "{lines:?}");
}

fn messages_decode(island: &Island) {
    let odometry = &island.ask("peer_echo.py", "/robot1/odom nav_msgs/msg/Odometry")["messages"][0];
    assert_eq!(odometry["header"]["frame_id"], "map");
    assert_eq!(odometry["child_frame_id"], "robot1/base_link");
    let orientation = |axis: &str| number(odometry, &format!("/pose/pose/orientation/{axis}"));
    assert!((libm::hypot(orientation("z"), orientation("w")) - 1.0).abs() < 1e-9, "{odometry}");
    let x = number(odometry, "/pose/pose/position/x");
    assert!((0.0..2.48).contains(&x) && number(odometry, "/pose/covariance/0") > 0.0, "{odometry}");

    let commands = island.ask("peer_echo.py", "/robot1/cmd_vel geometry_msgs/msg/TwistStamped --count 40");
    assert!(number(&commands, "/rate") > 20.0, "{}", commands["rate"]);
    let command = &commands["messages"][39];
    assert_eq!(command["header"]["frame_id"], "robot1/base_link");
    assert!(number(command, "/twist/linear/x").abs() <= 0.3 && number(command, "/twist/linear/y") == 0.0, "{command}");

    let state = &island.ask("peer_echo.py", "/robot1/leader_state trench_msgs/msg/LeaderState")["messages"][0];
    assert_eq!((&state["robot"], &state["epoch"]), (&json!("robot1"), &json!(1)));
    assert!((1.0..=2.0).contains(&number(state, "/rank")) && number(state, "/queue") <= 1.0, "{state}");
    let distance = libm::hypot(
        number(state, "/goal/x") - number(state, "/position/x"),
        number(state, "/goal/y") - number(state, "/position/y"),
    );
    // goal_distance is predicted to when the command acts.
    assert!((number(state, "/goal_distance") - distance).abs() < 0.03 && distance < 0.5, "{state}");
}

fn parameter_services_work(island: &Island) {
    let ask = |action: &str| island.ask("peer_param.py", &format!("/robot1/formation_controller {action}"));
    let gain = || number(&ask("get gains.k2"), "/value");
    let names = ask("list");
    assert!(names["names"].as_array().unwrap().contains(&json!("gains.k2")), "{names}");
    assert_eq!(gain(), 2.5);
    assert_eq!(ask("set gains.k2 3.0")["successful"], true);
    assert_eq!(gain(), 3.0);
    for (change, reasons) in [
        ("gains.k2 0.01", ["K3 < K1 + 2 c1 K2", "4.3.1"]),
        ("gains.k2 -1.0", ["K2 > 0", "(4.8)"]),
        ("gains.k2 21.0", ["gains.k2", "20"]),
        ("gains.k2 true", ["gains.k2", "bool"]),
        ("gains.k22 1.0", ["gains.k22", "did you mean"]),
        ("robot 7", ["robot", "fixed"]),
    ] {
        let answer = ask(&format!("set {change}"));
        let reason = answer["reason"].as_str().unwrap();
        assert_eq!(answer["successful"], false, "{change}");
        assert!(reasons.iter().all(|part| reason.contains(part)), "{change}: {reason}");
        assert_eq!(gain(), 3.0, "{change}: the old value stays in force");
    }
}

/// Longer than a datagram of an Ethernet, which RustDDS cannot answer with (docs/decisions/0001).
#[test]
fn interop_all_parameters_at_once() {
    let island = Island::new(2);
    let program = std::path::Path::new(env!("CARGO_BIN_EXE_trench")).with_file_name("formation_controller");
    let mut controller = island.command(program).args(["--ros-args", "-r", "__ns:=/robot1"]).spawn().unwrap();
    let output = island
        .python("peer_param.py")
        .args(["/robot1/formation_controller", "dump", "--timeout", "40"])
        .output()
        .unwrap();
    controller.kill().unwrap();
    controller.wait().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let values: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(values.as_object().unwrap().len() > 50, "{values}");
    assert_eq!(number(&values, "/gains.k2"), 2.5);
}

/// A picture of grey noise (a linear congruence).
fn noise(width: u32, height: u32) -> image::RgbImage {
    let mut state = 1_u32;
    image::RgbImage::from_fn(width, height, |_, _| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        image::Rgb([120 + (state >> 29) as u8; 3])
    })
}

/// 768 x 576 pixels of rgb8, 30 times a second, from rclpy with Fast DDS: 1.3 MB a frame over the loopback's UDP; and as JPEG.
#[test]
fn interop_an_ordinary_camera_driver_loses_one_frame_of_a_hundred_at_most() {
    const FRAMES: u64 = 300;
    let island = Island::new(1);
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let camera = |name: &str| root.join("config/cameras").join(name).display().to_string();
    let program = std::path::Path::new(env!("CARGO_BIN_EXE_trench")).with_file_name("overhead_localizer");
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("picture.jpeg");
    noise(768, 576).save(&picture).unwrap();
    let jpeg = format!("--topic /overhead/image_raw/compressed --jpeg {}", picture.display());
    // Best effort as cameras' profile of ROS has it, and reliable as image_transport's default is.
    for (qos, input, what) in [
        ("best_effort,volatile,5", "image", ""),
        ("reliable,volatile,10", "image", ""),
        ("best_effort,volatile,5", "compressed", jpeg.as_str()),
    ] {
        let mut localizer = island
            .command(&program)
            .args(["--ros-args", "-p", "robots:=[robot1]", "-p", &format!("input:={input}")])
            .args(["-p", &format!("camera_info_file:={}", camera("overhead.yaml"))])
            .args(["-p", &format!("mount_file:={}", camera("overhead_mount.yaml"))])
            .spawn()
            .unwrap();
        let diagnostics = island.follow("/diagnostics diagnostic_msgs/msg/DiagnosticArray --qos reliable,volatile,100");
        let sent = island.ask("peer_camera.py", &format!("--qos {qos} --frames {FRAMES} {what}"));
        let mut taken = 0;
        // The last ones are told of when no more come.
        diagnostics.until("no frames come any more", |message| {
            let camera = message["status"]
                .as_array()
                .unwrap()
                .iter()
                .find(|part| part["name"] == "/overhead_localizer: camera" && part["message"] == "no frames");
            let value = |part: &Value| {
                let values = part["values"].as_array().unwrap();
                let frames = values.iter().find(|value| value["key"] == "frames")?;
                frames["value"].as_str()?.parse::<u64>().ok()
            };
            taken = camera.and_then(value).unwrap_or(0);
            taken > 0
        });
        localizer.kill().unwrap();
        localizer.wait().unwrap();
        println!("{qos} {input}: {taken} of {FRAMES} frames were taken ({sent})");
        assert!(100 * (FRAMES - taken) <= FRAMES, "{qos} {input}: {taken} of {FRAMES} frames were taken ({sent})");
    }
}

/// Frames that rclpy asks for go to it in pieces of our own making (docs/decisions/0012): Fast DDS puts them together again.
#[test]
fn interop_a_viewer_gets_the_camera_s_pictures_whole() {
    const COUNT: usize = 40;
    let island = Island::new(2);
    let folder = tempfile::tempdir().unwrap();
    let pictures = [noise(768, 576), image::RgbImage::from_pixel(768, 576, image::Rgb([9, 90, 200]))];
    for (index, picture) in pictures.iter().enumerate() {
        picture.save(folder.path().join(format!("frame{index}.png"))).unwrap();
    }
    let lens = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("config/cameras/overhead.yaml");
    let mut camera = island
        .command(std::path::Path::new(env!("CARGO_BIN_EXE_trench")).with_file_name("overhead_camera"))
        .args(["--ros-args", "-p", "source:=folder", "-p", "repeat:=true", "-p", "rate:=20.0"])
        .args(["-p", &format!("path:={}", folder.path().display())])
        .args(["-p", &format!("camera_info_file:={}", lens.display())])
        .args(["-p", "publish_over_network:=[\"/overhead/image_raw\"]"])
        .spawn()
        .unwrap();
    let seen = island.ask("peer_viewer.py", &format!("/overhead/image_raw --count {COUNT}"));
    camera.kill().unwrap();
    camera.wait().unwrap();
    let expected = pictures.map(|picture| u64::from(crc32fast::hash(picture.as_raw())));
    let mut counts = [0; 2];
    for picture in seen["pictures"].as_array().unwrap() {
        assert_eq!((&picture["encoding"], &picture["sides"]), (&"rgb8".into(), &serde_json::json!([768, 576, 2304])));
        let which = expected.iter().position(|crc| picture["crc32"] == *crc);
        counts[which.unwrap_or_else(|| panic!("a picture that nobody sent: {picture}"))] += 1;
    }
    println!("{counts:?} pictures, {} a second of 20", seen["rate"]);
    assert!(counts.iter().all(|count| 3 * count > COUNT), "{counts:?}: as they take turns");
}

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
    let run = island.ask("peer_echo.py", "/run_state trench_msgs/msg/RunState --qos reliable,transient_local,1");
    assert_eq!(run["messages"][0]["state"], 1, "armed: {run}");
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
