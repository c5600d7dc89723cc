//! What `trench check` says, word for word, and how it exits.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::Path;
use std::process::{Command, Output};

fn check(arguments: &[&str]) -> Output {
    let folder = env!("CARGO_MANIFEST_DIR");
    Command::new(env!("CARGO_BIN_EXE_trench")).arg("check").args(arguments).current_dir(folder).output().unwrap()
}

/// Compares with tests/check/NAME; with TRENCH_UPDATE_GOLDEN=1 writes it instead.
fn golden(name: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/check").join(name);
    if std::env::var_os("TRENCH_UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, text).unwrap();
    }
    assert_eq!(text, std::fs::read_to_string(&path).unwrap(), "{name}");
}

fn judged(name: &str, arguments: &[&str], code: i32) {
    let output = check(arguments);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{error}");
    golden(name, &String::from_utf8(output.stdout).unwrap());
}

#[test]
fn what_is_shipped_holds() {
    judged("square.txt", &["launch/square.launch.yaml"], 0);
    judged("column.txt", &["launch/column.launch.yaml"], 0);
    judged("wings.txt", &["config/formations/wings.yaml", "config/profiles/chain.yaml"], 0);
    judged("triangle_thesis.txt", &["launch/triangle.launch.yaml", "profile:=thesis"], 0);
    // The scenario that names the same launch file with the same argument.
    judged("triangle_thesis.txt", &["config/scenarios/4.6_triangle.yaml"], 0);
}

#[test]
fn what_fails_is_named_with_its_equation() {
    judged("pursuit.txt", &["launch/pursuit.launch.yaml"], 0);
    judged("chain.txt", &["launch/chain.launch.yaml"], 0);
    judged(
        "queue.txt",
        &["config/formations/square.yaml", "config/formations/column.yaml", "tests/check/queue.yaml"],
        0,
    );
    judged("crowded.txt", &["tests/check/crowded.yaml", "tests/check/turning.yaml"], 1);
    judged("turning.json", &["tests/check/turning.yaml", "--json"], 1);
}

#[test]
fn what_cannot_be_read_is_named_with_its_line() {
    let refused = |arguments: &[&str], expected: &str| {
        let output = check(arguments);
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), error.as_str()), (Some(2), expected));
        assert!(output.stdout.is_empty());
    };
    refused(
        &["tests/check/crossing.yaml"],
        "trench check: tests/check/crossing.yaml:4: queues[0].segment: the curve meets itself after 0.75 m and after \
         3.0307764064044154 m: move the points between, or split it into two segments; mend the segment\n",
    );
    refused(
        &["config/cameras/overhead.yaml"],
        "trench check: config/cameras/overhead.yaml: is no formation (queues:), launch (launch:), scenario (kind:) or parameter \
         file (ros__parameters:); check one of these\n",
    );
    refused(
        &["tests/check/none.yaml"],
        "trench check: tests/check/none.yaml: FILE = tests/check/none.yaml: cannot be read: No such file or directory (os \
         error 2); name a file that exists and is text\n",
    );
    refused(
        &["launch/square.launch.yaml", "profil:=thesis"],
        "trench check: no launch file that is checked has the argument profil; trench launch FILE --show-args lists them\n",
    );
    assert_eq!(check(&[]).status.code(), Some(2));
}

/// Whatever reads a file says the same of one that is none, and where what is no YAML is wrong.
#[test]
fn files_that_cannot_be_read_are_told_alike() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path.display().to_string()
    };
    let missing = folder.path().join("missing.yaml").display().to_string();
    let inner = folder.path().join("folder.yaml");
    std::fs::create_dir(&inner).unwrap();
    let told = |subcommand: &str, path: &str| {
        let output = Command::new(env!("CARGO_BIN_EXE_trench")).args([subcommand, path]).output().unwrap();
        assert!(!output.status.success(), "{subcommand} {path}");
        String::from_utf8(output.stderr).unwrap().replace(&format!("trench {subcommand}: "), "")
    };
    let readable = "name a file that exists and is text";
    for (path, parts) in [
        (missing, ["No such file or directory", readable]),
        (inner.display().to_string(), ["Is a directory", readable]),
        (path("latin.yaml", b"name: \xe9\n"), ["valid UTF-8", readable]),
        (path("tab.yaml", b"name: a\n\tkind: queue\n"), ["tab.yaml:1:", "at column 7"]),
        (path("bracket.yaml", b"name: a\nrobots: [1, 2\n"), ["bracket.yaml:3:", "at column 1"]),
    ] {
        let checked = told("check", &path);
        assert!(parts.iter().all(|part| checked.contains(part)), "{checked}");
        for subcommand in ["sim", "plot"] {
            assert_eq!(told(subcommand, &path), checked);
        }
    }
    // Empty, or of another kind: no launch file either.
    assert_eq!(told("plot", &path("empty.yaml", b"")), told("check", &path("empty.yaml", b"")));
    let formation = told("plot", "config/formations/square.yaml");
    assert!(
        formation.contains("describes no run: give a bag, a table (.csv) of trench sim, or a scenario"),
        "{formation}"
    );
    let nothing = told("plot", &folder.path().join("bag").display().to_string());
    assert!(nothing.contains("does not exist; give a bag (folder or .mcap file)"), "{nothing}");
    let launch = told("plot", "launch/square.launch.yaml");
    assert!(launch.contains("is a launch file, whose node cores run in trench sim"), "{launch}");
}

/// A file in a folder of its own, which a test names on its command line.
fn written(folder: &tempfile::TempDir, text: &str) -> String {
    let path = folder.path().join("own.yaml");
    std::fs::write(&path, text).unwrap();
    path.display().to_string()
}

/// The nodes' own words, not a second opinion: what is refused here is refused there, and the other way round.
#[test]
fn what_a_node_refuses_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (parameters, line, said) in [
        ("law: nothing", 3, "law = \"nothing\": is no law; one of: robust"),
        ("law: zoned\n    zoned.direction: [1.0]", 4, "zoned.direction = [1.0]: is no direction; write x and y"),
        (
            "law: zoned\n    zoned.direction: [0.0, 0.0]",
            4,
            "zoned.direction = [0.0, 0.0]: is no direction; write x and y",
        ),
        ("law: chain\n    obstacles: {pole: 0.3, cut: 0.2}", 4, "obstacles.cut = 0.2: "),
        ("law: chain\n    encroaching: nonsense", 4, "encroaching = \"nonsense\": is nothing that encroaches"),
        ("team_link: x", 3, "team_link = \"x\": is no team link; write radio or network"),
        ("field: [1.0, 1.0, 0.0, 0.0]", 3, "field = [1.0, 1.0, 0.0, 0.0]: has no area"),
    ] {
        let path = written(&folder, &format!("/**/formation_controller:\n  ros__parameters:\n    {parameters}\n"));
        let output = check(&[&path]);
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{parameters}: {error}");
        assert!(error.starts_with(&format!("trench check: {path}:{line}: {said}")), "{parameters}: {error}");
        assert!(output.stdout.is_empty());
    }
}

/// Two robots in one another.
const TOO_NEAR: &str = "poses:=[0.5, 0.5, 0.0, 0.55, 0.5, 0.0, 0.5, 1.0, 0.0, 0.5, 1.5, 0.0, 0.5, 2.0, 0.0, 1.0, 0.5, 0.0, 1.0, 1.0, 0.0, 1.0, 1.5, 0.0]";

/// One that begins nowhere near the field.
const FAR_OUT: &str = "poses:=[0.5, 0.5, 0.0, 1.5, 0.5, 0.0, 0.5, 1.0, 0.0, 0.5, 1.5, 0.0, 0.5, 2.0, 0.0, 1.0, 0.5, 0.0, 1.0, 1.0, 0.0, 50.0, 2.0, 0.0]";

/// Nodes of all kinds, by launch files: `trench sim` says the same.
#[test]
fn what_a_node_of_a_launch_file_refuses_is_refused_by_check_and_sim_alike() {
    let by = |subcommand: &str, arguments: &[&str]| {
        let folder = env!("CARGO_MANIFEST_DIR");
        let output = Command::new(env!("CARGO_BIN_EXE_trench"))
            .args([subcommand, "launch/chain.launch.yaml"])
            .args(arguments)
            .current_dir(folder)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        String::from_utf8(output.stderr).unwrap().replace(&format!("trench {subcommand}: "), "")
    };
    for (argument, said) in [
        ("poses:=[0.5]", "poses = [0.5]: has 1 numbers for 8 robots; write x, y and heading for each robot"),
        ("bed:=nonsense", "nonsense"),
        (
            TOO_NEAR,
            "robot2 at (0.550, 0.500) is 0.0500 m from robot1 at (0.500, 0.500), and their bodies need 0.1600 m",
        ),
        (FAR_OUT, "the body of robot8 at (50.000, 2.000) is 46.0800 m out of the field"),
    ] {
        let (checked, simulated) = (by("check", &[argument]), by("sim", &[argument]));
        // The simulator ends at the first refusal, the check tells those of all nodes.
        assert!(simulated.contains(said), "{simulated}");
        assert!(checked.starts_with(&simulated), "{checked}");
    }
}

/// What is wrong with a launch file that a scenario names is told at the scenario's line: its words are no command line.
#[test]
fn what_a_scenario_says_to_a_launch_file_is_told_at_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let launch = format!("{}/launch/square.launch.yaml", env!("CARGO_MANIFEST_DIR"));
    for (scenario, line, said) in [
        ("launch: none.yaml".to_owned(), 3, "launch = none.yaml: cannot read "),
        (
            format!("launch: {launch}\narguments:\n  sed: \"1\""),
            5,
            "arguments.sed = 1: the launch file has no such argument; did you mean `bed`?",
        ),
        (
            format!("launch: {launch}\narguments:\n  seed: abc"),
            5,
            "arguments.seed = abc: testbed-1: parameters/1-6.yaml:3: seed",
        ),
        (format!("launch: {launch}\narguments:\n  profile: nonsense"), 5, "arguments.profile = nonsense: "),
        (
            format!("launch: {launch}\narguments:\n  seed: \"1\"\n  poses: \"[0.5]\""),
            6,
            "arguments.poses = [0.5]: testbed-1: parameters/1-5.yaml:3: poses = [0.5]: has 1 numbers for 4 robots",
        ),
    ] {
        let path = written(&folder, &format!("name: own\nkind: launch\n{scenario}\n"));
        for subcommand in ["check", "sim"] {
            let output = Command::new(env!("CARGO_BIN_EXE_trench")).args([subcommand, &path]).output().unwrap();
            let error = String::from_utf8(output.stderr).unwrap();
            assert_eq!(output.status.code(), Some(2), "{error}");
            assert!(error.starts_with(&format!("trench {subcommand}: {path}:{line}: {said}")), "{scenario}: {error}");
        }
    }
}
