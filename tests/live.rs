//! The experiments as processes in real time: `trench launch`, DDS, shared memory, a pseudo-terminal, judged from the
//! recorded bag.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod live_support;
#[path = "live_support/tuned.rs"]
mod tuned;

use live_support::{Launch, domain};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// Launches an experiment with the default profile and holds its bag against the bounds of that.
fn tuned_profile_keeps_its_bounds(launch: &Launch, file: &str) {
    let (status, text) = launch.finish(launch.recording(file, &["duration:=30.0"]));
    assert!(status.success(), "{status}\n{text}");
    tuned::keeps_its_bounds(&launch.judge(&[]));
}

#[test]
fn live_triangle_tuned() {
    tuned_profile_keeps_its_bounds(&Launch::new(domain(0)), "triangle.launch.yaml");
}

#[test]
fn live_square_tuned() {
    tuned_profile_keeps_its_bounds(&Launch::new(domain(0)), "square.launch.yaml");
}

/// `trench router`, and where it listens.
struct Router(Child, String);

impl Router {
    fn start() -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trench"));
        command.arg("router").env("ZENOH_CONFIG_OVERRIDE", "listen/endpoints=[\"tcp/127.0.0.1:0\"]");
        let mut router = command.stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(router.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let place = line.split_whitespace().last().unwrap_or_default().to_owned();
        Self(router, place)
    }
}

impl Drop for Router {
    fn drop(&mut self) {
        self.0.kill().unwrap();
        self.0.wait().unwrap();
    }
}

#[test]
fn live_square_over_zenoh() {
    let router = Router::start();
    let mut launch = Launch::new(domain(0));
    launch.variables = vec![
        ("RMW_IMPLEMENTATION", "rmw_zenoh_cpp".to_owned()),
        ("ZENOH_CONFIG_OVERRIDE", format!("connect/endpoints=[\"{}\"]", router.1)),
    ];
    tuned_profile_keeps_its_bounds(&launch, "square.launch.yaml");
}

#[test]
fn live_triangle_thesis() {
    let launch = Launch::new(domain(1));
    let arguments = ["profile:=thesis", "bed:=ideal", "duration:=60.5", "tolerance:=0.2"];
    let (status, text) = launch.finish(launch.recording("triangle.launch.yaml", &arguments));
    assert!(status.success(), "{status}\n{text}");
    let summary = launch.judge(&[24.0, 60.0]);
    assert_eq!(summary.contacts, [], "{summary}");
    for robot in &summary.robots {
        let distance = robot.final_distance.unwrap();
        assert!((0.12..=0.165).contains(&distance), "{}: {distance} m", robot.name);
    }
    assert!(summary.shape[0].error < 0.12, "{} m at 24 s", summary.shape[0].error);
    assert!(summary.shape[1].error < 0.06, "{} m at 60 s", summary.shape[1].error);
}

#[test]
fn live_a_run_that_does_not_form_says_so() {
    let launch = Launch::new(domain(2));
    // Two seconds are too short to get anywhere.
    let (status, text) = launch.finish(launch.recording("square.launch.yaml", &["duration:=2.0", "tolerance:=0.001"]));
    assert_eq!(status.code(), Some(10), "{text}");
    assert!(text.contains("the formation does not stand: further than 0.001 m from their goals: robot1"), "{text}");
}

#[test]
fn live_a_wrong_gain_stops_the_launch_with_its_equation() {
    let launch = Launch::new(domain(3));
    let profile = launch.folder.path().join("wrong.yaml");
    let text = "/**/formation_controller:\n  ros__parameters:\n    gains: {k1: 0.1, k2: 1.0, k3: 9.0}\n";
    std::fs::write(&profile, text).unwrap();
    let output = Command::new(Path::new(env!("CARGO_BIN_EXE_trench")).with_file_name("formation_controller"))
        .args(["--ros-args", "-r", "__ns:=/robot1", "--params-file"])
        .arg(&profile)
        .env("ROS_DOMAIN_ID", launch.domain.to_string())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(3));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("wrong.yaml:3: gains.k3 = 9"), "{said}");
    assert!(said.contains("K3 < K1 + 2 c1 K2") && said.contains("write 4.6"), "{said}");
}
