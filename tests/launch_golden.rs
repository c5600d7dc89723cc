//! Launch files in, processes or errors out, through the real `trench launch`.
//!
//! `tests/launch/expected.json` holds what the real `ros2 launch` gave the processes of `main.launch.yaml`;
//! `tests/launch/bad/NAME.txt` the error for `NAME.launch.yaml` (written anew where TRENCH_BLESS is set).

#![expect(clippy::unwrap_used, reason = "a test fails by panicking, in its helper functions too")]

use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn launch_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/launch")
}

/// Runs `trench launch` in `folder`.
fn launch(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_trench"))
        .arg("launch")
        .args(arguments)
        .current_dir(folder)
        .env_remove("AMENT_PREFIX_PATH")
        .output()
        .unwrap()
}

/// What `show`, run as every process of main.launch.yaml, printed into the log files of a run.
fn shown(arguments: &[&str]) -> Vec<Value> {
    let run = tempfile::tempdir().unwrap();
    let run_folder = run.path().to_str().unwrap();
    let file = launch_folder().join("main.launch.yaml");
    let mut all = vec![file.to_str().unwrap(), "--run-dir", run_folder];
    all.extend(arguments);
    let output = launch(Path::new("/"), &all);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let log = std::fs::read_to_string(run.path().join("log/launch.log")).unwrap();
    let shown = log.lines().filter_map(|line| line.split_once("] SHOW "));
    comparable(shown.map(|(_, json)| serde_json::from_str(json).unwrap()).collect(), run_folder)
}

/// What `--dry-run` says that the processes of main.launch.yaml would get, as `show` would have printed it.
fn foretold(arguments: &[&str]) -> Vec<Value> {
    let run = tempfile::tempdir().unwrap();
    let run_folder = run.path().to_str().unwrap();
    let file = launch_folder().join("main.launch.yaml");
    let mut all = vec![file.to_str().unwrap(), "--dry-run", "--run-dir", run_folder];
    all.extend(arguments);
    let output = launch(Path::new("/"), &all);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(std::fs::read_dir(run.path()).unwrap().count(), 0, "a dry run leaves files");
    let processes: Vec<Value> = serde_json::from_slice(&output.stdout).unwrap();
    comparable(processes.iter().map(as_shown).collect(), run_folder)
}

/// A process of the dry run as `show` prints itself.
fn as_shown(process: &Value) -> Value {
    let argv = &process["argv"].as_array().unwrap()[1..];
    let pairs = argv.iter().zip(argv.iter().skip(1));
    let files = pairs.filter(|(flag, _)| *flag == "--params-file").map(|(_, path)| path.as_str().unwrap());
    let text = |path: &str| match &process["parameter_files"][path] {
        Value::Null => json!(std::fs::read_to_string(path).unwrap()),
        text => text.clone(),
    };
    let variable = |name: &str| process["env"].get(name).cloned().unwrap_or_else(|| json!(""));
    json!({
        "tag": variable("SHOW_TAG"),
        "global": variable("SHOW_GLOBAL"),
        "argv": argv,
        "params": files.map(text).collect::<Vec<_>>(),
    })
}

/// In the order and with the words of expected.json.
fn comparable(mut shown: Vec<Value>, run_folder: &str) -> Vec<Value> {
    shown.iter_mut().for_each(|process| neutralise(process, run_folder));
    shown.sort_by_key(|process| process["tag"].as_str().unwrap().to_owned());
    shown
}

/// Replaces what differs between machines, as expected.json does.
fn neutralise(process: &mut Value, run_folder: &str) {
    let folder = launch_folder().canonicalize().unwrap().display().to_string();
    for argument in process["argv"].as_array_mut().unwrap() {
        let text = argument.as_str().unwrap();
        if text.starts_with(run_folder) {
            *argument = json!("<temporary parameter file>");
        } else {
            *argument = json!(text.replace(&folder, "<dir>"));
        }
    }
}

#[test]
fn processes_get_what_the_real_ros2_launch_gives_them() {
    let text = std::fs::read_to_string(launch_folder().join("expected.json")).unwrap();
    let expected: Value = serde_json::from_str(&text).unwrap();
    for (run, arguments) in [("default arguments", [].as_slice()), ("view:=true", &["view:=true"])] {
        assert_eq!(json!(shown(arguments)), expected["runs"][run], "{run}");
        assert_eq!(json!(foretold(arguments)), expected["runs"][run], "{run}, as --dry-run foretells");
    }
}

#[test]
fn bad_files_are_refused_with_these_words() {
    let folder = launch_folder().join("bad");
    let mut names: Vec<String> = std::fs::read_dir(&folder)
        .unwrap()
        .filter_map(|entry| {
            entry.unwrap().file_name().into_string().unwrap().strip_suffix(".launch.yaml").map(str::to_owned)
        })
        .collect();
    names.sort();
    assert!(names.len() > 25, "{names:?}");
    let run = tempfile::tempdir().unwrap();
    for name in names {
        let output = launch(&folder, &[&format!("{name}.launch.yaml"), "--run-dir", run.path().to_str().unwrap()]);
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{name}: {error}");
        let error: String = error.split_inclusive('\n').filter(|line| !line.contains(": run folder ")).collect();
        let golden = folder.join(format!("{name}.txt"));
        if std::env::var_os("TRENCH_BLESS").is_some() {
            std::fs::write(&golden, &error).unwrap();
        }
        assert_eq!(error, std::fs::read_to_string(&golden).unwrap_or_default(), "{name}");
    }
}

#[test]
fn wrong_arguments_are_refused() {
    let folder = launch_folder();
    for (arguments, expected) in [
        (
            ["main.launch.yaml", "veiw:=true"],
            "trench launch: command line: veiw = true: the launch file has no such argument; did you mean `view`?\n",
        ),
        (
            ["nowhere.launch.yaml", "--dry-run"],
            "trench launch: command line: cannot read nowhere.launch.yaml: No such file or directory (os error 2); check the path\n",
        ),
    ] {
        let output = launch(&folder, &arguments);
        assert_eq!(String::from_utf8(output.stderr).unwrap(), expected);
        assert_eq!(output.status.code(), Some(2));
    }
}

#[test]
fn two_nodes_of_one_name_are_warned_about() {
    let output = launch(&launch_folder(), &["duplicate_names.launch.yaml", "--dry-run"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(
        String::from_utf8(output.stderr).unwrap(),
        "trench launch: warning: duplicate_names.launch.yaml:6: /robot1/controller: two nodes have this name, \
         the first at duplicate_names.launch.yaml:5; give each its own name or namespace\n"
    );
}
