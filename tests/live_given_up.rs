//! A node that all robots need is lost for good while they drive: an emergency stop holds them. One that nobody needs: they go on.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[expect(dead_code, reason = "other live tests use the rest")]
mod live_support;
#[path = "support/running.rs"]
mod running;

use live_support::{Launch, domain, programs};
use running::Running;
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use trench_bag::BagReader;
use trench_bag::run::{Run, distance};
use trench_msgs::Message;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::std_msgs::Bool;

const PATIENCE: Duration = Duration::from_secs(60);

/// From the first word of the stop until no wheel turns, s: a word on the network, stop packets at 20 Hz some of which are lost, and
/// braking from 0.3 m/s at 0.5 m/s^2.
const STANDS_WITHIN: f64 = 1.0;

/// A launch under way, and what it says.
struct UnderWay<'a> {
    launch: &'a Launch,
    process: Running,
}

impl<'a> UnderWay<'a> {
    fn start(launch: &'a Launch, mut command: Command) -> Self {
        let process = Running::start(command.stdout(Stdio::null()).stderr(Stdio::null()));
        Self { launch, process }
    }

    fn log(&self) -> String {
        std::fs::read_to_string(self.launch.folder.path().join("run/log/launch.log")).unwrap_or_default()
    }

    /// Waits until the log says something.
    fn wait_for<T>(&self, what: &str, find: impl Fn(&str) -> Option<T>) -> T {
        let start = Instant::now();
        loop {
            let log = self.log();
            if let Some(found) = find(&log) {
                return found;
            }
            assert!(start.elapsed() < PATIENCE, "{what} not in:\n{log}");
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Until robots are on their way: the operator tells of them every 2 s.
    fn wait_for_motion(&self) {
        self.wait_for("t = 4 s", |log| log.contains("t =   4.").then_some(()));
    }

    /// Kills the life of a process that begins next, or has begun.
    fn kill(&self, name: &str, life: usize) {
        let begins = format!("[{name}-");
        let pid = self.wait_for(&format!("start {life} of {name}"), |log| {
            let mut starts =
                log.lines().filter(|line| line.contains(&begins) && line.contains("process started with pid ["));
            let (_, pid) = starts.nth(life)?.rsplit_once('[')?;
            pid.strip_suffix(']')?.parse().ok()
        });
        kill_process(Pid::from_raw(pid).unwrap(), Signal::KILL).unwrap();
    }

    fn finish(mut self) -> (Option<i32>, String) {
        (self.process.0.wait().unwrap().code(), self.log())
    }
}

/// A program that launches start.
fn program(name: &str) -> PathBuf {
    programs::trench().with_file_name(name)
}

/// Starts a node of a launch by hand, with what the launch gives it.
fn by_hand(launch: &Launch, mut dry_run: Command, name: &str) -> Running {
    let output = dry_run.arg("--dry-run").output().unwrap();
    let plan: Vec<Value> = serde_json::from_slice(&output.stdout).unwrap();
    let node = plan.iter().find(|process| process["label"].as_str().unwrap().starts_with(name)).unwrap();
    let mut arguments = node["argv"].as_array().unwrap().iter().map(|argument| argument.as_str().unwrap());
    let program = program(arguments.next().unwrap());
    let mut command = Command::new(program);
    command.args(arguments).stdout(Stdio::null()).stderr(Stdio::null());
    command.envs(dry_run.get_envs().filter_map(|(name, value)| Some((name, value?))));
    // Before the launch says it: what is not of the launch ends with the test.
    assert!(launch.folder.path().join("run/parameters").exists());
    Running::start(&mut command)
}

/// The times at which something was said on a topic, s since t0.
fn said<M: Message>(bag: &BagReader, run: &Run, topic: &str, is_it: impl Fn(&M) -> bool) -> Vec<f64> {
    let topic = bag.topic(topic).unwrap();
    let messages = bag.messages().map(Result::unwrap).filter(|message| message.topic == topic);
    let said = messages.filter(|message| is_it(&M::decode(message).unwrap()));
    said.map(|message| (message.log_time as i64 - run.t0.unwrap()) as f64 / 1e9).collect()
}

#[test]
fn live_a_localizer_that_dies_again_and_again_is_an_emergency() {
    let launch = Launch::new(domain(0));
    let command = || launch.recording("square.launch.yaml", &["render:=false", "duration:=14.0"]);
    let under_way = UnderWay::start(&launch, command());
    under_way.wait_for_motion();
    // Its first life was no short one: five more are.
    (0..=5).for_each(|life| under_way.kill("overhead_localizer", life));
    under_way.wait_for("the stop", |log| log.contains("emergency_stop_of_launch").then_some(()));
    // Somebody mends it: all is there again, and still nothing may move.
    let mended = by_hand(&launch, command(), "overhead_localizer");
    let (code, log) = under_way.finish();
    drop(mended);
    assert_eq!(code, Some(12), "{log}");
    let last = log.lines().last().unwrap();
    assert!(last.contains("[overhead_localizer-") && last.contains("was given up"), "{log}");
    assert_eq!(log.matches("all robots need it, and it is not started again: stopping them").count(), 1, "{log}");

    let bag = launch.recorded();
    let run = Run::from_bag(&bag).unwrap();
    let stopped = *said(&bag, &run, "/emergency_stop", |word: &Bool| word.data).first().unwrap();
    let in_force =
        |array: &DiagnosticArray| array.status.iter().any(|status| status.message.contains("emergency stop"));
    assert!(said(&bag, &run, "/diagnostics", in_force).len() > 3, "the bridge says that it holds");
    let (_, end) = run.span().unwrap();
    let seen = said(&bag, &run, "/team_state", |_: &trench_msgs::msg::TeamState| true);
    let again = seen.iter().filter(|time| **time > stopped + STANDS_WITHIN).count();
    assert!(again > 60, "the localizer is there again: {again} ticks from {stopped} s to {end} s");
    for (robot, track) in &run.robots {
        let fastest = track.poses.iter().filter(|pose| pose.time < 4.0).map(|pose| pose.v.abs()).fold(0.0, f64::max);
        assert!(fastest > 0.05, "{robot} drove: {fastest} m/s");
        let rest: Vec<_> = track.poses.iter().filter(|pose| pose.time > stopped + STANDS_WITHIN).collect();
        let moved = rest.iter().map(|pose| distance(pose.position(), rest[0].position())).fold(0.0, f64::max);
        assert!(rest.len() > 60 && moved < 0.001, "{robot} moved {moved} m in {} samples after the stop", rest.len());
        let goal = track.goal_at(end).unwrap();
        let away = distance(goal, rest[0].position());
        assert!(away > 0.1, "{robot} has nowhere to go: {away} m");
    }
}

#[test]
fn live_robots_go_on_without_a_recorder_and_a_view() {
    let launch = Launch::new(domain(1));
    let file = launch.folder.path().join("watched.launch.yaml");
    let (trench, square) = (program("trench"), launch.root.join("launch/square.launch.yaml"));
    let text = format!(
        "launch:\n- executable: {{name: view, cmd: \"{} view --port 0\"}}\n- include:\n    file: {}\n    arg:\n    \
         - {{name: record, value: \"true\"}}\n    - {{name: bag, value: {}}}\n    - {{name: port, value: {}}}\n    \
         - {{name: render, value: \"false\"}}\n    - {{name: duration, value: \"24.0\"}}\n",
        trench.display(),
        square.display(),
        launch.folder.path().join("bag").display(),
        launch.folder.path().join("port").display(),
    );
    std::fs::write(&file, text).unwrap();
    let under_way = UnderWay::start(&launch, launch.command(file.to_str().unwrap(), ""));
    under_way.wait_for_motion();
    ["bag_recorder", "view"].into_iter().for_each(|name| under_way.kill(name, 0));
    let (code, log) = under_way.finish();
    // Each stands within `tolerance` of its vertex, which it was on its way to.
    assert_eq!(code, Some(0), "{log}");
    assert_eq!(log.matches("process has died").count(), 2, "{log}");
    assert!(!log.contains("emergency"), "{log}");
}
