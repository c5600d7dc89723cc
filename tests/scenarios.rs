//! `trench sim` on scenario files: the same bytes twice, bags that are runs, errors that name file and line.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking, in its helper functions too")]

use std::path::Path;
use std::process::{Command, Output};
use trench_bag::BagReader;
use trench_bag::run::Run;

fn trench(arguments: &[&str]) -> Output {
    let root = env!("CARGO_MANIFEST_DIR");
    Command::new(env!("CARGO_BIN_EXE_trench")).args(arguments).current_dir(root).output().unwrap()
}

fn simulate(folder: &Path) -> (Vec<u8>, Vec<u8>, Vec<u8>) {
    // A bag says its own name: equal bytes need equal names.
    std::fs::create_dir(folder).unwrap();
    let (csv, bag) = (folder.join("run.csv"), folder.join("run"));
    let file = "config/scenarios/7.12.yaml";
    let output =
        trench(&["sim", file, "--quiet", "--json", "--csv", csv.to_str().unwrap(), "--bag", bag.to_str().unwrap()]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mcap = bag.join("run_0.mcap");
    (output.stdout, std::fs::read(csv).unwrap(), std::fs::read(mcap).unwrap())
}

#[test]
fn the_same_bytes_twice() {
    let folder = tempfile::tempdir().unwrap();
    let (first, second) = (simulate(&folder.path().join("first")), simulate(&folder.path().join("second")));
    assert!(first == second, "two runs differ");

    let summary: serde_json::Value = serde_json::from_slice(&first.0).unwrap();
    assert!(summary["cases"][0]["conforms_after"].as_f64().unwrap() < 60.0, "{summary}");
    let run = Run::from_bag(&BagReader::open(&folder.path().join("first/run")).unwrap()).unwrap();
    assert_eq!((run.robots.len(), run.undecodable), (1, 0));
    assert_eq!(run.formation.unwrap().queues[0].segment.points.len(), 2);
    let table = Run::from_csv(&String::from_utf8(first.1).unwrap()).unwrap();
    assert_eq!(table.robots["r1"].poses.len(), run.robots["r1"].poses.len());
}

#[test]
fn launch_scenarios_run_the_node_cores() {
    let output = trench(&["sim", "config/scenarios/4.6_square.yaml", "--quiet", "--json"]);
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(summary["robots"].as_array().unwrap().len(), 4, "{summary}");
}

#[test]
fn mistakes_are_told_with_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("wrong.yaml");
    std::fs::write(&file, "name: a\nkind: regulation\nduration: 1.0\nstep: -1.0\n").unwrap();
    let output = trench(&["sim", file.to_str().unwrap()]);
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(told.contains("wrong.yaml:4: step = -1.0: is not positive; write a number above 0"), "{told}");
}
