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
