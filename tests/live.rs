//! The experiments as processes in real time: `trench launch`, DDS, shared memory, a pseudo-terminal, judged from the
//! recorded bag.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod live_support;
#[path = "live_support/tuned.rs"]
mod tuned;

use live_support::{Launch, domain};
use rustix::process::{Pid, test_kill_process};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Launches an experiment with the default profile and holds its bag against the bounds of that.
fn tuned_profile_keeps_its_bounds(launch: &Launch, file: &str, more: &[&str]) {
    let (status, text) = launch.finish(launch.recording(file, &[&["duration:=30.0"], more].concat()));
    assert!(status.success(), "{status}\n{text}");
    tuned::keeps_its_bounds(&launch.judge(&[]));
}

#[test]
fn live_triangle_tuned() {
    tuned_profile_keeps_its_bounds(&Launch::new(domain(0)), "triangle.launch.yaml", &[]);
}

#[test]
fn live_square_tuned() {
    tuned_profile_keeps_its_bounds(&Launch::new(domain(0)), "square.launch.yaml", &[]);
}

/// `eval "$(scripts/ros2-launch --env)"` first.
#[test]
#[ignore = "wants the real ros2 launch, from GitHub: scripts/ros2-launch"]
fn live_triangle_and_square_under_the_real_ros2_launch() {
    for file in ["triangle.launch.yaml", "square.launch.yaml"] {
        let launch = Launch::new(domain(0));
        let ours = launch.recording(file, &["duration:=30.0"]);
        let programs = Path::new(env!("CARGO_BIN_EXE_trench")).parent().unwrap();
        let path = format!("{}:{}", programs.display(), std::env::var("PATH").unwrap());
        let mut command = Command::new("ros2");
        command.arg("launch").arg(launch.root.join("launch").join(file));
        command.args(ours.get_args().filter(|argument| argument.to_string_lossy().contains(":=")));
        command.envs(ours.get_envs().filter_map(|(name, value)| Some((name, value?)))).env("PATH", path);
        command.env("ROS_LOG_DIR", launch.folder.path().join("log"));
        let (status, text) = launch.finish(command);
        assert!(status.success() && text.contains("the formation stands"), "{file}: {status}\n{text}");
        let ended = text.matches("process has finished cleanly").count();
        assert!(ended >= 8 && !text.contains("process has died"), "{file}: {ended} processes ended cleanly\n{text}");
        let summary = launch.judge(&[]);
        tuned::keeps_its_bounds(&summary);
        let worst = summary.robots.iter().filter_map(|robot| robot.final_distance).fold(0.0, f64::max);
        println!("worst final distance {worst:.4} m under ros2 launch ({file})");
    }
}

/// Rendered, seen, answered and sent in half of the time that other tests have.
#[test]
fn live_square_at_sixty_frames_a_second() {
    let launch = Launch::new(domain(0));
    tuned_profile_keeps_its_bounds(&launch, "square.launch.yaml", &["bed:=fast"]);
    let recorded = launch.recorded();
    let topic = recorded.topic("/team_state").unwrap();
    let ticks = recorded.messages().filter(|message| message.as_ref().unwrap().topic == topic).count();
    println!("{ticks} ticks in 30 s");
    assert!(ticks >= 1_710, "{ticks} ticks in 30 s: more than a twentieth of the frames never came");
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
    tuned_profile_keeps_its_bounds(&launch, "square.launch.yaml", &[]);
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

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let to = to.join(entry.file_name());
        match entry.file_type().unwrap().is_dir() {
            true => copy(&entry.path(), &to),
            false => drop(std::fs::copy(entry.path(), to).unwrap()),
        }
    }
}

/// Has `launch` use copies of the repository's files, in one of which `text` is replaced.
fn change(launch: &mut Launch, file: &str, [text, by]: [&str; 2]) {
    let copies = launch.folder.path().join("copies");
    for folder in ["launch", "config"] {
        copy(&launch.root.join(folder), &copies.join(folder));
    }
    let file = copies.join(file);
    let before = std::fs::read_to_string(&file).unwrap();
    assert_eq!(before.matches(text).count(), 1, "{text} in {}", file.display());
    std::fs::write(&file, before.replace(text, by)).unwrap();
    launch.root = copies;
}

/// Launches the square for ten minutes with `text` replaced in one of its files: the launch ends by itself and at once, and
/// its last words are those of the node `program`, which name what to mend.
fn is_refused(offset: u32, file: &str, replaced: [&str; 2], program: &str, words: &[&str]) {
    let mut launch = Launch::new(domain(offset));
    change(&mut launch, file, replaced);
    let start = Instant::now();
    let output = launch.recording("square.launch.yaml", &["duration:=600.0"]).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(3), "{said}");
    // Starting ten processes on a busy machine takes most of this.
    assert!(start.elapsed() < Duration::from_secs(30), "{:?}\n{said}", start.elapsed());
    launch.left_nothing_behind();
    let pids = said.split("process started with pid [").skip(1).map(|rest| rest.split_once(']').unwrap().0);
    let pids: Vec<_> = pids.map(|pid| Pid::from_raw(pid.parse().unwrap()).unwrap()).collect();
    assert!(pids.len() >= 10 && pids.iter().all(|pid| test_kill_process(*pid).is_err()), "{pids:?}\n{said}");
    let last = said.lines().last().unwrap();
    assert!(last.starts_with(&format!("{program}: ")), "{said}");
    assert!(words.iter().all(|word| last.contains(word)), "{last}");
}

#[test]
fn live_a_wrong_gain_ends_the_launch_with_its_equation() {
    let words = ["config/profiles/tuned.yaml:7: gains.k3 = 15", "K3 < K1 + 2 c1 K2 = 12.5083", "write 12.3683"];
    is_refused(3, "config/profiles/tuned.yaml", ["k3: 1.2", "k3: 15.0"], "formation_controller", &words);
}

#[test]
fn live_a_vertex_beside_its_segment_ends_the_launch() {
    let words = [
        "config/formations/square.yaml:17: queues[1].vertices[0]: is 0.0500 m away from the segment",
        "[1.2750, 1.3000]",
    ];
    let change = ["[[1.275, 1.30], ", "[[1.275, 1.35], "];
    is_refused(3, "config/formations/square.yaml", change, "leader_assignment", &words);
}
