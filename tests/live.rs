//! The experiments as processes in real time: `trench launch`, DDS, shared memory, a pseudo-terminal, judged from the
//! recorded bag.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};
use trench_bag::BagReader;
use trench_bag::run::{Run, RunSummary, SummaryOptions, summary};

/// The programs a launch starts; `cargo build --workspace --bins` makes them.
const PROGRAMS: [&str; 8] = [
    "bag_recorder",
    "formation_controller",
    "leader_assignment",
    "obstacle_mapper",
    "operator",
    "overhead_localizer",
    "rf_bridge",
    "testbed",
];

/// A launch with a domain, shared memory, a state folder and a serial port of its own.
struct Launch {
    folder: tempfile::TempDir,
    domain: u32,
}

impl Launch {
    fn new(domain: u32) -> Self {
        let trench = Path::new(env!("CARGO_BIN_EXE_trench"));
        for program in PROGRAMS {
            let path = trench.with_file_name(program);
            assert!(path.exists(), "{} is missing: run cargo build --workspace --bins", path.display());
        }
        Self { folder: tempfile::tempdir().unwrap(), domain }
    }

    fn bag(&self) -> PathBuf {
        self.folder.path().join("bag")
    }

    /// Runs a launch file to its end, recording a bag.
    fn run(&self, file: &str, arguments: &[&str]) -> (ExitStatus, String) {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let output = Command::new(env!("CARGO_BIN_EXE_trench"))
            .arg("launch")
            .arg(root.join("launch").join(file))
            .arg("record:=true")
            .arg(format!("bag:={}", self.bag().display()))
            .arg(format!("port:={}", self.folder.path().join("port").display()))
            .args(arguments)
            .arg("--run-dir")
            .arg(self.folder.path().join("run"))
            .env("ROS_DOMAIN_ID", self.domain.to_string())
            .env("TRENCH_SHM_PREFIX", self.shared_memory())
            .env("TRENCH_STATE_DIR", self.folder.path().join("state"))
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
        (output.status, worst_first(&text))
    }

    fn judge(&self, shape_times: &[f64]) -> RunSummary {
        let bag = BagReader::open(&self.bag()).unwrap();
        assert_eq!(bag.damage().len(), 0, "{:?}", bag.damage());
        let run = Run::from_bag(&bag).unwrap();
        let options = SummaryOptions { shape_times: shape_times.to_vec(), ..SummaryOptions::default() };
        let summary = summary(&run, &options);
        assert!(summary.ground_truth && summary.undecodable == 0);
        println!("{summary}");
        summary
    }
}

impl Launch {
    /// The prefix of its shared memory.
    fn shared_memory(&self) -> String {
        format!("live{}_{}_", self.domain, std::process::id())
    }
}

impl Drop for Launch {
    fn drop(&mut self) {
        if let Err(error) = trench_runtime::forget_shared_memory(&self.shared_memory()) {
            println!("shared memory of the test stays behind: {error}");
        }
    }
}

/// What was said, errors before warnings before the rest: of a failed test often the first lines alone are shown.
fn worst_first(text: &str) -> String {
    let rank = |line: &&str| {
        if ["ERROR", "panicked"].iter().any(|word| line.contains(word)) {
            0
        } else {
            2 - u8::from(line.contains("WARN"))
        }
    };
    let mut lines: Vec<&str> = text.lines().collect();
    lines.sort_by_key(rank);
    lines.join("\n")
}

/// A domain no other test of this run uses at the same time: real-time tests run alone. Domains above 101 would have
/// their ports among those that the kernel gives to anyone (/proc/sys/net/ipv4/ip_local_port_range).
fn domain(offset: u32) -> u32 {
    71 + (std::process::id() % 7) * 4 + offset
}

fn no_contact(summary: &RunSummary) {
    assert!(summary.closest.as_ref().unwrap().gap > 0.0, "{summary}");
}

/// Launches an experiment with the default profile and holds its bag against the bounds of that.
fn tuned_profile_keeps_its_bounds(domain: u32, file: &str) {
    let launch = Launch::new(domain);
    let (status, text) = launch.run(file, &["duration:=30.0"]);
    assert!(status.success(), "{status}\n{text}");
    let summary = launch.judge(&[]);
    no_contact(&summary);
    for robot in &summary.robots {
        assert!(robot.final_distance.unwrap() <= 0.02, "{}", robot.name);
    }
    let shape = summary.max_shape_error.unwrap();
    assert!(shape <= 0.02, "shape error {shape} m over the last third of the motion and at rest");
}

#[test]
fn live_triangle_tuned() {
    tuned_profile_keeps_its_bounds(domain(0), "triangle.launch.yaml");
}

#[test]
fn live_square_tuned() {
    tuned_profile_keeps_its_bounds(domain(0), "square.launch.yaml");
}

#[test]
fn live_triangle_thesis() {
    let launch = Launch::new(domain(1));
    let arguments = ["profile:=thesis", "bed:=ideal", "duration:=60.5", "tolerance:=0.2"];
    let (status, text) = launch.run("triangle.launch.yaml", &arguments);
    assert!(status.success(), "{status}\n{text}");
    let summary = launch.judge(&[24.0, 60.0]);
    no_contact(&summary);
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
    let (status, text) = launch.run("square.launch.yaml", &["duration:=2.0", "tolerance:=0.001"]);
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
