//! Journals: golden ones replay bit for bit, a changed gain is found, damage is told, a live run replays too.
#![expect(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helper functions too")]

#[path = "replay/damage.rs"]
mod damage;
#[path = "replay/gain.rs"]
mod gain;
#[path = "replay/live.rs"]
mod live;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use trench_harness::replay::{Verdict, replay};
use trench_journal::JournalReader;

/// The golden runs and how many nodes took part.
const GOLDEN: [(&str, usize); 2] = [("triangle", 9), ("square", 10)];

/// The folder of a golden run; `scripts/update-golden` makes it.
fn golden(run: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bags").join(run)
}

fn journals(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

fn check(arguments: &[&str], path: &Path) -> (Option<i32>, String) {
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_trench")).args(["bag", "check"]).arg(path).args(arguments).output().unwrap();
    (status.code(), String::from_utf8_lossy(&stdout).into_owned() + &String::from_utf8_lossy(&stderr))
}

#[test]
fn golden_journals_replay_bit_for_bit() {
    for (run, nodes) in GOLDEN {
        let paths = journals(&golden(run));
        assert_eq!(paths.len(), nodes, "{run}");
        for path in paths {
            let report = replay(&JournalReader::open(&path).unwrap()).unwrap();
            let remedy = "after an intended change of behaviour run scripts/update-golden";
            assert_eq!(report.verdict, Verdict::Equal, "{}: {remedy}", path.display());
            assert!(report.events > 20 && report.outputs > 20, "{}: {report:?}", path.display());
            assert_eq!(report.equal, report.outputs);
        }
    }
}

#[test]
fn golden_journals_are_small_and_name_no_machine() {
    let mut bytes = 0;
    for (run, _) in GOLDEN {
        for path in journals(&golden(run)) {
            bytes += path.metadata().unwrap().len();
            for file in &JournalReader::open(&path).unwrap().start().files {
                assert!(file.path.starts_with("/tmp/trench-golden/"), "{}", file.path);
            }
        }
    }
    assert!(bytes < 1 << 20, "{bytes} bytes");
}

#[test]
fn the_command_tells_node_by_node() {
    let (code, said) = check(&[], &golden("square"));
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(said.matches("  equal\n").count(), 10, "{said}");
    let (code, said) = check(&["--node", "/robot2/formation_controller", "--json"], &golden("square"));
    assert_eq!(code, Some(0), "{said}");
    let said: serde_json::Value = serde_json::from_str(&said).unwrap();
    assert_eq!(said.as_array().unwrap().len(), 1);
    assert_eq!(said[0]["node"], "/robot2/formation_controller");
    assert_eq!(said[0]["verdict"], "equal");
}

#[test]
fn what_is_no_journal_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let (code, said) = check(&[], folder.path());
    assert_eq!(code, Some(2));
    assert!(said.contains("no journals in") && said.contains("trench launch --journal"), "{said}");
    let (code, said) = check(&["--node", "robot9"], &golden("square"));
    assert_eq!(code, Some(2));
    assert!(said.contains("no journal of a node robot9; there are those of /leader_assignment"), "{said}");
}
