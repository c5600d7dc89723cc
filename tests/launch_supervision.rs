//! How `trench launch` starts, watches and ends real processes.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking, in its helper functions too")]

#[path = "support/own_memory.rs"]
mod own_memory;

use own_memory::OwnMemory;
use rustix::process::{Pid, Signal, kill_process, test_kill_process};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// How long anything here may take on a busy machine before the test fails.
const PATIENCE: Duration = Duration::from_secs(30);

/// A running `trench launch` of a file with the given actions.
struct Run {
    folder: TempDir,
    launcher: Child,
}

impl Run {
    fn start(actions: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("test.launch.yaml");
        std::fs::write(&file, format!("launch:\n{actions}")).unwrap();
        let launcher = Command::new(env!("CARGO_BIN_EXE_trench"))
            .args(["launch", "test.launch.yaml", "--run-dir", "run"])
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        Self { folder, launcher }
    }

    fn log(&self) -> String {
        std::fs::read_to_string(self.folder.path().join("run/log/launch.log")).unwrap_or_default()
    }

    /// Waits until the log holds all of `texts`.
    fn wait_for(&self, texts: &[&str]) -> String {
        let start = Instant::now();
        loop {
            let log = self.log();
            if texts.iter().all(|text| log.contains(text)) {
                return log;
            }
            assert!(start.elapsed() < PATIENCE, "{texts:?} not in:\n{log}");
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    fn signal(&self, signal: Signal) {
        kill_process(Pid::from_child(&self.launcher), signal).unwrap();
    }

    /// The launcher's exit code, output and log, once it has ended.
    fn finish(self) -> (Option<i32>, Output, String) {
        let output = self.launcher.wait_with_output().unwrap();
        let log = std::fs::read_to_string(self.folder.path().join("run/log/launch.log")).unwrap_or_default();
        (output.status.code(), output, log)
    }
}

/// Runs to the end: exit code, output, log.
fn run(actions: &str) -> (Option<i32>, Output, String) {
    Run::start(actions).finish()
}

#[test]
fn an_interrupt_ends_all_cleanly() {
    let run = Run::start(
        "- executable: {cmd: sleep 1000}\n- executable: {cmd: \"sh -c 'trap \\\"exit 0\\\" INT; echo ready; while :; do sleep 0.1; done'\"}\n",
    );
    run.wait_for(&["[sleep-1]: process started", "ready"]);
    run.signal(Signal::INT);
    let (code, _, log) = run.finish();
    assert_eq!(code, Some(0), "{log}");
    assert_eq!(log.matches("finished cleanly").count(), 2, "{log}");
    assert!(!log.contains("SIGTERM"), "{log}");
}

#[test]
fn what_ignores_an_interrupt_is_terminated_and_what_ignores_that_is_killed() {
    let run = Run::start(
        "- executable: {name: deaf, sigterm_timeout: 0.2, cmd: \"sh -c 'trap \\\"\\\" INT; echo a; sleep 1000'\"}\n\
         - executable: {name: stubborn, sigterm_timeout: 0.2, sigkill_timeout: 0.2, cmd: \"sh -c 'trap \\\"\\\" INT TERM; echo b; sleep 1000'\"}\n",
    );
    run.wait_for(&["[deaf-1] a", "[stubborn-2] b"]);
    run.signal(Signal::TERM);
    let (code, _, log) = run.finish();
    assert_eq!(code, Some(1), "{log}");
    assert!(log.contains("[deaf-1]: has not ended in time, sending SIGTERM"), "{log}");
    assert!(!log.contains("[deaf-1]: has not ended in time, sending SIGKILL"), "{log}");
    assert!(log.contains("[stubborn-2]: has not ended in time, sending SIGKILL"), "{log}");
    assert!(log.contains("signal: 15") && log.contains("signal: 9"), "{log}");
}

#[test]
fn a_second_signal_does_not_wait() {
    let run = Run::start(
        "- executable: {name: deaf, sigterm_timeout: 1000.0, cmd: \"sh -c 'trap \\\"\\\" INT; echo a; sleep 1000'\"}\n",
    );
    run.wait_for(&["[deaf-1] a"]);
    run.signal(Signal::INT);
    run.wait_for(&["sending signal 'SIGINT'"]);
    run.signal(Signal::INT);
    let (code, _, log) = run.finish();
    assert_eq!(code, Some(1), "{log}");
}

#[test]
fn the_process_that_ends_the_run_decides_the_exit_code() {
    for (command, expected) in [("sh -c 'exit 0'", 0), ("sh -c 'exit 7'", 7), ("sh -c 'kill -9 $$'", 137)] {
        let (code, _, log) = run(&format!(
            "- executable: {{cmd: sleep 1000}}\n- executable: {{on_exit: shutdown, cmd: \"{command}\"}}\n"
        ));
        assert_eq!(code, Some(expected), "{log}");
        assert!(log.contains("[sleep-1]: process has finished cleanly"), "{log}");
    }
}

#[test]
fn an_interrupt_before_the_goal_is_no_success() {
    let run = Run::start("- executable: {cmd: sleep 1000, on_exit: shutdown}\n");
    run.wait_for(&["process started"]);
    run.signal(Signal::INT);
    assert_eq!(run.finish().0, Some(130));
}

#[test]
fn a_failure_shows_in_the_exit_code() {
    let (code, _, log) = run("- executable: {cmd: \"true\"}\n- executable: {cmd: \"false\"}\n");
    assert_eq!(code, Some(1), "{log}");
    assert!(log.contains("[ERROR] [false-2]: process has died"), "{log}");
}

#[test]
fn a_crash_loop_is_bounded_and_reported() {
    let (code, _, log) = run("- node: {exec: \"false\", respawn: \"true\"}\n");
    assert_eq!(code, Some(1), "{log}");
    assert_eq!(log.matches("process started").count(), 5, "{log}");
    assert!(log.contains("ended 5 times within 1 s of its start: not starting it again"), "{log}");
}

#[test]
fn a_crash_loop_of_lives_that_are_not_short_is_bounded_and_reported_too() {
    let (code, _, log) = run("- node: {exec: sh, respawn: \"true\", args: \"-c 'trap : INT; sleep 1.1; exit 1'\"}\n");
    assert_eq!(code, Some(1), "{log}");
    assert_eq!(log.matches("process started").count(), 10, "{log}");
    assert!(log.contains("ended 10 times within 60 s: not starting it again"), "{log}");
}

/// Starts a launch of a node with a program of this name, which does what `script` says, beside a sleeper of three seconds.
fn run_beside_a_sleeper(name: &str, script: &str, more: &str) -> (Option<i32>, String) {
    let programs = tempfile::tempdir().unwrap();
    let program = programs.path().join(name);
    std::fs::write(&program, format!("#!/bin/sh\n{script}\n")).unwrap();
    std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).unwrap();
    // What calls for help is a node: in a domain and memory of its own it stops nobody else's robots.
    let number = std::process::id();
    let memory = OwnMemory(format!("given_up{number}_{name}"));
    let variables = [("ROS_DOMAIN_ID", (61 + number % 10).to_string()), ("TRENCH_SHM_PREFIX", memory.0.clone())];
    let set = variables.map(|(name, value)| format!("- set_env: {{name: {name}, value: \"{value}\"}}\n")).concat();
    let node = format!("- node: {{exec: {}, {more}}}\n", program.display());
    let (code, _, log) = run(&format!("{set}{node}- executable: {{name: sleeper, cmd: sleep 3}}\n"));
    assert!(log.contains("[sleeper-2]: process has finished cleanly"), "{log}");
    (code, log)
}

const RESPAWN: &str = "respawn: \"true\"";

#[test]
fn an_emergency_stop_is_called_when_a_node_that_all_robots_need_is_given_up() {
    for (name, more, reason) in [
        ("rf_bridge", RESPAWN, "not starting it again"),
        ("obstacle_mapper", "respawn: \"true\", respawn_max_retries: 1", "was started again 1 times: no more"),
        ("leader_assignment", "name: once", "process has died"),
        ("formation_controller", "args: \"--namespaces x\"", "process has died"),
    ] {
        let (code, log) = run_beside_a_sleeper(name, "exit 1", more);
        assert_eq!(code, Some(12), "{log}");
        let (_, after) = log.rsplit_once(reason).unwrap();
        assert!(after.contains("it is not started again: stopping them"), "{log}");
        assert!(after.contains("[emergency_stop-3]: process started"), "{log}");
        assert!(after.contains("]: stop"), "it says so: {log}");
        // It goes on until nothing else runs.
        let (before, end) = after.split_once("[sleeper-2]: process has finished cleanly").unwrap();
        assert!(!before.contains("[emergency_stop-3]: process has"), "{log}");
        assert!(end.contains("[emergency_stop-3]: process has finished cleanly"), "{log}");
        assert!(
            log.trim_end().ends_with("was given up, so that the robots were stopped: see above why it died"),
            "{log}"
        );
    }
}

#[test]
fn nobody_is_stopped_for_one_robot_s_controller_or_for_what_watches_or_for_what_was_asked_to_end() {
    for (name, script, more, code) in [
        ("formation_controller", "exit 1", RESPAWN, 1),
        ("bag_recorder", "exit 1", "name: recorder", 1),
        ("rf_bridge", "exit 0", "name: bridge", 0),
    ] {
        let (ended, log) = run_beside_a_sleeper(name, script, more);
        assert_eq!(ended, Some(code), "{log}");
        assert!(!log.contains("emergency_stop"), "{log}");
    }
}

#[test]
fn a_node_that_refuses_its_configuration_ends_the_run_and_has_the_last_word() {
    // The second is told to end while it is about to say the same: said once.
    let refuses =
        "exec: sh, respawn: \"true\", args: \"-c 'trap : INT; sleep 0.3; echo gain = 9: write 4.6 >&2; exit 3'\"";
    let late = "exec: sh, respawn: \"true\", args: \"-c 'trap : INT; sleep 9; echo gain = 9: write 4.6 >&2; exit 3'\"";
    let (code, _, log) =
        run(&format!("- node: {{{refuses}}}\n- node: {{{late}}}\n- executable: {{cmd: sleep 1000}}\n"));
    assert_eq!(code, Some(3), "{log}");
    assert_eq!(log.matches("process started").count(), 3, "{log}");
    assert!(log.contains("[sh-1]: refuses what it was started with: that ends the run"), "{log}");
    assert!(log.contains("[sleep-3]: process has finished cleanly"), "{log}");
    assert!(log.contains("[sh-2] gain = 9: write 4.6\n"), "{log}");
    assert!(log.ends_with("[ERROR] [sh-1]: refused what it was started with:\ngain = 9: write 4.6\n"), "{log}");
}

#[test]
fn the_code_of_a_refusal_means_nothing_where_the_process_is_no_node() {
    let executable = "cmd: \"sh -c 'exit 3'\", respawn: \"true\", respawn_delay: 0.01, respawn_max_retries: 2";
    let (code, _, log) = run(&format!("- executable: {{{executable}}}\n"));
    assert_eq!(code, Some(1), "{log}");
    assert_eq!(log.matches("process started").count(), 3, "{log}");
}

#[test]
fn a_process_that_somebody_stops_is_named() {
    let run = Run::start("- executable: {cmd: sleep 60, name: sleeper}\n");
    let log = run.wait_for(&["process started with pid ["]);
    let pid = log.split("pid [").nth(1).and_then(|rest| rest.split(']').next()).unwrap().parse().unwrap();
    let pid = Pid::from_raw(pid).unwrap();
    let wait_for = |text: &str, times: usize| {
        let start = Instant::now();
        while run.log().matches(text).count() < times {
            assert!(start.elapsed() < PATIENCE, "{text} not {times} times in:\n{}", run.log());
            std::thread::sleep(Duration::from_millis(10));
        }
    };
    for times in 1..=2 {
        kill_process(pid, Signal::STOP).unwrap();
        wait_for("[sleeper-1]: process was stopped by a signal", times);
        kill_process(pid, Signal::CONT).unwrap();
        wait_for("[sleeper-1]: process goes on", times);
    }
    run.signal(Signal::INT);
    let (code, _, log) = run.finish();
    assert_eq!((code, log.matches("process was stopped by a signal").count()), (Some(0), 2), "{log}");
}

#[test]
fn a_process_is_started_again_as_often_as_asked() {
    let (code, _, log) =
        run("- node: {exec: \"true\", respawn: \"true\", respawn_delay: 0.01, respawn_max_retries: 2}\n");
    assert_eq!(code, Some(0), "{log}");
    assert_eq!(log.matches("process started").count(), 3, "{log}");
}

#[test]
fn output_goes_where_the_file_says() {
    let (code, output, log) = run("- executable: {name: quiet, cmd: \"sh -c 'echo one; echo two >&2'\"}\n\
         - executable: {name: loud, output: screen, cmd: \"sh -c 'printf \\\"three\\\\\\\\nno newline\\\"'\"}\n");
    let (stdout, stderr) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert_eq!(code, Some(0), "{log}");
    assert_eq!(stdout, "[loud-2] three\n[loud-2] no newline\n");
    assert!(stderr.contains("[quiet-1] two\n") && !stderr.contains("[quiet-1] one"), "{stderr}");
    assert!(log.contains("[quiet-1] one\n") && log.contains("[loud-2] no newline\n"), "{log}");
}

#[test]
fn timers_delay_what_is_below_them() {
    let (code, _, log) =
        run("- timer: {period: 0.3, children: [{executable: {cmd: echo late}}]}\n- executable: {cmd: echo early}\n");
    assert_eq!(code, Some(0), "{log}");
    let position = |text: &str| log.find(text).unwrap();
    assert!(position("] early") < position("[echo-1]: process started"), "{log}");
    assert!(log.contains("[echo-1] late"), "{log}");
}

#[test]
fn the_environment_reaches_the_processes() {
    let (code, output, log) = run("- set_env: {name: GREETING, value: hello}\n\
         - group:\n  - set_env: {name: GREETING, value: inner}\n\
         - unset_env: {name: HOME}\n\
         - executable: {output: screen, env: [{name: OWN, value: \"$(env GREETING) you\"}], cmd: \"sh -c 'echo $GREETING $OWN ${HOME-unset}'\"}\n");
    assert_eq!(code, Some(0), "{log}");
    assert_eq!(String::from_utf8_lossy(&output.stdout), "[sh-1] hello hello you unset\n");
}

#[test]
fn processes_end_when_the_launcher_is_killed() {
    let run = Run::start("- executable: {cmd: sleep 1000}\n");
    let log = run.wait_for(&["process started with pid ["]);
    let pid = log.split("pid [").nth(1).and_then(|rest| rest.split(']').next()).unwrap().parse().unwrap();
    let pid = Pid::from_raw(pid).unwrap();
    run.signal(Signal::KILL);
    run.finish();
    let start = Instant::now();
    while test_kill_process(pid).is_ok() && !is_zombie(pid) {
        assert!(start.elapsed() < PATIENCE, "process {pid} lives on");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Whether the process has ended and only waits for a parent to notice.
fn is_zombie(pid: Pid) -> bool {
    let status = std::fs::read_to_string(Path::new("/proc").join(pid.to_string()).join("stat"));
    status.is_ok_and(|status| status.rsplit(") ").next().is_some_and(|rest| rest.starts_with('Z')))
}
