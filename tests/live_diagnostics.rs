//! What `trench launch` says of its processes on /diagnostics, as a recorder on the same network hears it.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[path = "support/own_memory.rs"]
mod own_memory;
#[path = "support/programs.rs"]
mod programs;
#[path = "support/running.rs"]
mod running;

use own_memory::OwnMemory;
use running::Running;
use rustix::process::{Pid, Signal, kill_process};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use trench_bag::BagReader;
use trench_msgs::Message;
use trench_msgs::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};

const PATIENCE: Duration = Duration::from_secs(60);

/// A node that is started again, one that crashes on each start, and a process that is no node.
const ACTIONS: &str = "launch:\n\
    - node: {exec: obstacle_mapper, name: mapper, namespace: /lab, respawn: \"true\", respawn_delay: 0.2}\n\
    - node: {exec: \"false\", name: crasher, respawn: \"true\"}\n\
    - executable: {cmd: sleep 1000}\n";

/// A launch on a network of its own, and who records its /diagnostics.
struct Bench {
    folder: tempfile::TempDir,
    memory: OwnMemory,
    variables: Vec<(&'static str, String)>,
    _router: Option<Running>,
}

impl Bench {
    /// `number` differs between the tests of this file.
    fn new(number: u32, over_zenoh: bool) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let domain = 40 + (std::process::id() % 7) * 4 + number;
        let memory = OwnMemory(format!("ld{}n{number}", std::process::id()));
        let mut variables = vec![
            ("ROS_DOMAIN_ID", domain.to_string()),
            ("TRENCH_SHM_PREFIX", memory.0.clone()),
            ("TRENCH_STATE_DIR", folder.path().join("state").display().to_string()),
        ];
        let mut router = None;
        if over_zenoh {
            let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
            let mut command = Command::new(programs::trench());
            command.arg("router").stdout(Stdio::null());
            command.env("ZENOH_CONFIG_OVERRIDE", format!("listen/endpoints=[\"tcp/127.0.0.1:{port}\"]"));
            router = Some(Running::start(&mut command));
            let clients = format!("mode=\"client\";connect/endpoints=[\"tcp/127.0.0.1:{port}\"]");
            variables.extend([("RMW_IMPLEMENTATION", "rmw_zenoh_cpp".to_owned()), ("ZENOH_CONFIG_OVERRIDE", clients)]);
        }
        Self { folder, memory, variables, _router: router }
    }

    fn start(&self, command: &mut Command) -> Running {
        command.envs(self.variables.iter().map(|(name, value)| (name, value)));
        Running::start(command.current_dir(self.folder.path()).stdout(Stdio::null()).stderr(Stdio::null()))
    }

    /// Begins to record.
    fn record(&self) -> Running {
        let mut command = Command::new(programs::trench().with_file_name("bag_recorder"));
        command.args([
            "--ros-args",
            "-p",
            "output:=bag",
            "-p",
            "topics:=['/diagnostics:diagnostic_msgs/msg/DiagnosticArray']",
        ]);
        self.start(&mut command)
    }

    /// The launch of a file with these actions.
    fn launch(&self, actions: &str, options: &[&str]) -> Running {
        std::fs::write(self.folder.path().join("test.launch.yaml"), actions).unwrap();
        let mut command = Command::new(programs::trench());
        command.args(["launch", "test.launch.yaml", "--run-dir", "run"]).args(options);
        self.start(&mut command)
    }

    fn log(&self) -> String {
        std::fs::read_to_string(self.folder.path().join("run/log/launch.log")).unwrap_or_default()
    }

    /// Waits until the launcher has said something so often.
    fn wait_for(&self, text: &str, times: usize) {
        wait_until(|| self.log().matches(text).count() >= times, || format!("{text} not in:\n{}", self.log()));
    }

    /// The latest process that the launcher has started by this label.
    fn pid_of(&self, label: &str) -> Pid {
        let log = self.log();
        let begin = format!("[{label}]: process started with pid [");
        let number = log.rsplit(&begin).next().unwrap().split(']').next().unwrap();
        Pid::from_raw(number.parse().unwrap()).unwrap()
    }

    /// What was recorded: the statuses of each message in the order in which they came.
    fn heard(&self, recorder: Running) -> Vec<DiagnosticStatus> {
        interrupt(recorder);
        let bag = BagReader::open(&self.folder.path().join("bag")).unwrap();
        let messages = bag.messages().map(|message| DiagnosticArray::decode(&message.unwrap()).unwrap());
        messages.flat_map(|message| message.status).collect()
    }
}

fn wait_until(is_so: impl Fn() -> bool, problem: impl Fn() -> String) {
    let start = Instant::now();
    while !is_so() {
        assert!(start.elapsed() < PATIENCE, "{}", problem());
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Ends it as Ctrl-C does; gives its exit code.
fn interrupt(mut running: Running) -> Option<i32> {
    kill_process(Pid::from_child(&running.0), Signal::INT).unwrap();
    running.0.wait().unwrap().code()
}

/// The children of a process that tell /diagnostics.
fn reporters(launcher: &Running) -> Vec<Pid> {
    let children = format!("/proc/{0}/task/{0}/children", launcher.0.id());
    let children = std::fs::read_to_string(children).unwrap_or_default();
    let is_reporter = |pid: &&str| {
        let line = std::fs::read(Path::new("/proc").join(pid).join("cmdline")).unwrap_or_default();
        String::from_utf8_lossy(&line).split('\0').nth(1) == Some("report")
    };
    children.split_whitespace().filter(is_reporter).map(|pid| Pid::from_raw(pid.parse().unwrap()).unwrap()).collect()
}

/// What was said of a name, each level with its text once in a row.
fn said(heard: &[DiagnosticStatus], name: &str) -> Vec<(u8, String)> {
    let matching = heard
        .iter()
        .filter(|status| status.name == name || status.name.starts_with("/launch_") && status.name.ends_with(name));
    let mut said: Vec<_> = matching.map(|status| (status.level, status.message.clone())).collect();
    said.dedup();
    said
}

fn value<'a>(status: &'a DiagnosticStatus, key: &str) -> &'a str {
    &status.values.iter().find(|value| value.key == key).unwrap().value
}

/// Kills the node and waits until nobody has a reason to tell of it any more.
fn a_node_is_killed(number: u32, over_zenoh: bool) {
    let bench = Bench::new(number, over_zenoh);
    let recorder = bench.record();
    let launcher = bench.launch(ACTIONS, &[]);
    bench.wait_for("not starting it again", 1);
    // The recorder and the reporter have met.
    std::thread::sleep(Duration::from_secs(3));
    kill_process(bench.pid_of("obstacle_mapper-1"), Signal::KILL).unwrap();
    bench.wait_for("[obstacle_mapper-1]: process started", 2);
    std::thread::sleep(Duration::from_millis(6500));
    kill_process(bench.pid_of("obstacle_mapper-1"), Signal::STOP).unwrap();
    bench.wait_for("was stopped by a signal", 1);
    kill_process(bench.pid_of("obstacle_mapper-1"), Signal::CONT).unwrap();
    bench.wait_for("process goes on", 1);
    std::thread::sleep(Duration::from_secs(1));
    let asked = Instant::now();
    assert_eq!(interrupt(launcher), Some(1), "{}", bench.log());
    assert!(asked.elapsed() < Duration::from_secs(5), "{:?}: {}", asked.elapsed(), bench.log());
    assert!(!bench.log().contains("who tells /diagnostics"), "{}", bench.log());
    let heard = bench.heard(recorder);

    let died = "has died (signal: 9 (SIGKILL))";
    let stopped = "was stopped by a signal";
    let expected = [
        (0, "runs".to_owned()),
        (1, format!("{died} and is to be started again")),
        (1, format!("{died} and was started again")),
        (0, "runs".to_owned()),
        (2, format!("{stopped} and does nothing until SIGCONT")),
        (1, format!("{stopped} and goes on")),
    ];
    assert_eq!(said(&heard, "/lab/mapper: process"), expected);
    let last = heard.iter().rfind(|status| status.name == "/lab/mapper: process").unwrap();
    let [label, starts, pid] = ["label", "starts", "pid"].map(|key| value(last, key));
    assert_eq!((label, starts), ("obstacle_mapper-1", "2"));
    assert_eq!(pid, bench.pid_of("obstacle_mapper-1").as_raw_pid().to_string());
    let crasher = "given up: has died (exit status: 1); ended 5 times within 1 s of its start: not starting it again";
    assert_eq!(said(&heard, "/crasher: process").last(), Some(&(2, crasher.to_owned())));
    assert_eq!(said(&heard, "/sleep-3: process"), [(0, "runs".to_owned())]);
    let summary = said(&heard, ": processes");
    assert!(summary.contains(&(2, "false-2: not as it should be".to_owned())), "{summary:?}");
    assert!(summary.contains(&(2, "false-2, obstacle_mapper-1: not as it should be".to_owned())), "{summary:?}");
}

#[test]
fn live_a_killed_a_stopped_and_a_given_up_node_are_named() {
    a_node_is_killed(0, false);
}

#[test]
fn live_a_killed_a_stopped_and_a_given_up_node_are_named_over_zenoh() {
    a_node_is_killed(1, true);
}

#[test]
fn live_who_tells_is_started_again_and_knows_what_was_and_tells_of_the_launcher_s_death() {
    let bench = Bench::new(2, false);
    let recorder = bench.record();
    let launcher = bench.launch(ACTIONS, &[]);
    bench.wait_for("not starting it again", 1);
    let first = reporters(&launcher);
    assert_eq!(first.len(), 1, "{}", bench.log());
    kill_process(first[0], Signal::KILL).unwrap();
    bench.wait_for("who tells /diagnostics has ended (signal: 9 (SIGKILL)): again in 1 s", 1);
    wait_until(|| reporters(&launcher).len() == 1, || bench.log());
    std::thread::sleep(Duration::from_secs(3));
    let second = reporters(&launcher)[0];
    assert_eq!(bench.log().matches("[obstacle_mapper-1]: process started").count(), 1, "nobody else is concerned");
    drop(launcher);
    wait_until(|| !Path::new("/proc").join(second.to_string()).exists(), || format!("{second} lives on"));
    let heard = bench.heard(recorder);
    let of_second =
        heard.iter().position(|status| status.name == "/lab/mapper: process").map(|first| &heard[first..]).unwrap();
    assert_eq!(said(of_second, "/lab/mapper: process"), [(0, "runs".to_owned())]);
    assert_eq!(said(of_second, "/crasher: process").last().unwrap().0, 2);
    let last = said(of_second, ": processes").pop();
    assert_eq!(last, Some((2, "the launcher was killed: its processes end".to_owned())));
}

#[test]
fn live_a_launch_without_a_network_runs_and_ends_all_the_same() {
    let mut bench = Bench::new(3, false);
    // Nobody is there.
    let clients = "mode=\"client\";connect/endpoints=[\"tcp/127.0.0.1:9\"]".to_owned();
    bench.variables.extend([("RMW_IMPLEMENTATION", "rmw_zenoh_cpp".to_owned()), ("ZENOH_CONFIG_OVERRIDE", clients)]);
    let actions =
        "launch:\n- node: {exec: sh, name: patient, args: \"-c 'trap \\\"exit 0\\\" INT; echo ready; sleep 1000'\"}\n";
    let actions = actions.replace("sleep 1000", "while :; do sleep 0.1; done");
    let launcher = bench.launch(&actions, &[]);
    bench.wait_for("ready", 1);
    // A client gives up after 8 s.
    bench.wait_for("who tells /diagnostics has ended (exit status: 4): again in 1 s", 1);
    let asked = Instant::now();
    assert_eq!(interrupt(launcher), Some(0), "{}", bench.log());
    assert!(asked.elapsed() < Duration::from_secs(2), "{:?}: {}", asked.elapsed(), bench.log());
    drop(bench.memory);
}

#[test]
fn live_it_can_be_switched_off() {
    let bench = Bench::new(0, false);
    let launcher = bench.launch(ACTIONS, &["--no-diagnostics"]);
    bench.wait_for("not starting it again", 1);
    assert_eq!(reporters(&launcher), []);
    assert_eq!(interrupt(launcher), Some(1));
}
