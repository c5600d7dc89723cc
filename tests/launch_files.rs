//! The files of `launch/`, held against what the real `ros2 launch` gives each of their processes.
//!
//! `tests/launch/real/NAME.json` is what it gave; `tests/launch/record.py` records it.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking, in its helper functions too")]

use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs::Permissions;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).canonicalize().unwrap()
}

/// The names of a folder's files with this ending, without it.
fn names(folder: &Path, ending: &str) -> BTreeSet<String> {
    let names = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names.filter_map(|name| name.strip_suffix(ending).map(str::to_owned)).collect()
}

/// What `trench launch --dry-run` says that the processes of a launch file get, in the words of record.py.
fn foretold(name: &str, arguments: &[String]) -> Value {
    let run = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_trench"))
        .arg("launch")
        .arg(repository().join("launch").join(format!("{name}.launch.yaml")))
        .args(arguments)
        .args(["--dry-run", "--run-dir"])
        .arg(run.path())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.is_empty(), "{name} {arguments:?}: {said}");
    let processes: Vec<Value> = serde_json::from_slice(&output.stdout).unwrap();
    let mut processes: Vec<Value> = processes.iter().map(process).collect();
    processes.sort_by_key(Value::to_string);
    json!(processes)
}

fn process(process: &Value) -> Value {
    let argv = process["argv"].as_array().unwrap().iter().map(|argument| argument.as_str().unwrap());
    let argv = argv.enumerate().map(|(index, argument)| match &process["parameter_files"][argument] {
        // `trench` is beside its nodes, wherever that is.
        Value::Null if index == 0 => json!(Path::new(argument).file_name().unwrap().to_str()),
        Value::Null => json!(relative(argument)),
        text => json!({ "parameters": relative(text.as_str().unwrap()) }),
    });
    let mut variables = process["env"].clone();
    // What all processes get from ours, and no launch file asks for.
    for ours in ["PATH", "TRENCH_RUN_DIR"] {
        assert!(variables.as_object_mut().unwrap().remove(ours).is_some(), "{process}");
    }
    json!({ "argv": argv.collect::<Vec<_>>(), "env": variables })
}

fn relative(text: &str) -> String {
    text.replace(repository().to_str().unwrap(), "<repository>")
}

/// Each recorded run of each launch file: the file's name, the arguments, what its processes got.
fn recorded() -> Vec<(String, Vec<String>, Vec<Value>)> {
    let real = repository().join("tests/launch/real");
    let files = names(&repository().join("launch"), ".launch.yaml");
    assert_eq!(files, names(&real, ".json"), "tests/launch/record.py records them");
    let runs = files.into_iter().flat_map(|name| {
        let text = std::fs::read_to_string(real.join(format!("{name}.json"))).unwrap();
        let runs: Vec<Value> = serde_json::from_str(&text).unwrap();
        runs.into_iter().map(move |run| {
            let processes = run["processes"].as_array().unwrap().clone();
            assert!(!processes.is_empty(), "{name}");
            (name.clone(), serde_json::from_value(run["arguments"].clone()).unwrap(), processes)
        })
    });
    runs.collect()
}

#[test]
fn processes_of_every_launch_file_get_what_the_real_ros2_launch_gives_them() {
    for (name, arguments, mut given) in recorded() {
        given.sort_by_key(Value::to_string);
        let advice = "where launch/ has changed, record anew: tests/launch/record.py";
        assert_eq!(foretold(&name, &arguments), json!(given), "{name} {arguments:?}: {advice}");
    }
}

/// What was recorded for its processes alone, with what the nodes need besides to start: a key that is there, a pose for each robot.
fn startable(arguments: Vec<String>, key: &str) -> Vec<String> {
    const FIVE: &str = "poses:=[0.4, 0.4, 0.3, 0.4, 1.4, -0.5, 0.8, 0.6, 1.2, 0.3, 0.9, 0.0, 1.7, 0.8, 0.0]";
    let has_five = arguments.iter().any(|argument| argument.starts_with("everybody:="));
    let arguments = arguments.into_iter().map(|argument| argument.replace("/etc/trench/key", key));
    arguments.chain(has_five.then(|| FIVE.to_owned())).collect()
}

#[test]
fn every_launch_file_holds_before_the_theory() {
    let folder = tempfile::tempdir().unwrap();
    let key = folder.path().join("key");
    std::fs::write(&key, "000102030405060708090a0b0c0d0e0f\n").unwrap();
    // A secret that others can read is refused.
    std::fs::set_permissions(&key, Permissions::from_mode(0o600)).unwrap();
    for (name, arguments, given) in recorded() {
        let arguments = startable(arguments, key.to_str().unwrap());
        let output = Command::new(env!("CARGO_BIN_EXE_trench"))
            .arg("check")
            .arg(repository().join("launch").join(format!("{name}.launch.yaml")))
            .args(&arguments)
            .output()
            .unwrap();
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success(), "{name} {arguments:?}: {said}{}", String::from_utf8_lossy(&output.stderr));
        let judged = |process: &Value| {
            ["formation_controller", "leader_assignment"].contains(&process["argv"][0].as_str().unwrap())
        };
        let expected = given.iter().any(judged);
        assert_ne!(said.contains("Nothing to judge."), expected, "{name} {arguments:?}: {said}");
    }
}

/// `eval "$(scripts/ros2-launch --env)"` first.
#[test]
#[ignore = "wants the real ros2 launch, from GitHub: scripts/ros2-launch"]
fn interop_the_real_ros2_launch_still_gives_what_was_recorded() {
    let output = Command::new(repository().join("tests/launch/record.py")).arg("--check").output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    println!("{said}");
}
