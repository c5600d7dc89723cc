//! Journals: golden ones replay bit for bit, a changed gain is found, damage is told, a live run replays too.
#![expect(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helper functions too")]

#[path = "replay/damage.rs"]
mod damage;
#[path = "replay/gain.rs"]
mod gain;
#[path = "replay/live.rs"]
mod live;
#[path = "support/programs.rs"]
mod programs;
#[path = "replay/secret.rs"]
mod secret;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use trench_harness::replay::{Verdict, replay};
use trench_journal::{Input, JournalReader, Payload, Record};

/// The golden runs: folders of journals that `scripts/update-golden` makes.
fn golden_runs() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bags");
    let folders = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let has_journals = |path: &PathBuf| journals(path).iter().any(|path| path.extension().is_some_and(|e| e == "mcap"));
    let mut runs: Vec<_> =
        folders.filter(has_journals).map(|path| path.file_name().unwrap().to_string_lossy().into_owned()).collect();
    runs.sort();
    runs
}

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
    let mut changed = String::new();
    let runs = golden_runs();
    for named in ["link_break", "localizer", "lost_robot", "square", "triangle"] {
        assert!(runs.iter().any(|run| run == named), "{named} is missing in {runs:?}");
    }
    for run in runs {
        let paths = journals(&golden(&run));
        // All nodes of a launch, or the localizer alone.
        assert!(paths.len() >= 9 || run == "localizer", "{run}: {paths:?}");
        for path in paths {
            let report = replay(&JournalReader::open(&path).unwrap()).unwrap();
            assert!(report.events >= 20 && report.outputs >= 20, "{}: {report:?}", path.display());
            match &report.verdict {
                Verdict::Equal => assert_eq!(report.equal, report.outputs),
                Verdict::NotReplayable { from, reason } => changed += &format!("{run}: not from {from} s: {reason}\n"),
                Verdict::Differs(first) => {
                    changed += &format!("{run}: {first}\n");
                    for (subject, change) in &report.changes.subjects {
                        changed += &format!("  {subject}: {change}\n");
                    }
                }
            }
        }
    }
    assert!(changed.is_empty(), "outputs changed; if that is intended, run scripts/update-golden\n{changed}");
}

#[test]
fn the_localizers_golden_frames_are_twenty() {
    let journal = JournalReader::open(&golden("localizer").join("overhead_localizer.mcap")).unwrap();
    let frames = journal.steps().map(Result::unwrap).filter(|step| is_frame(&step.records().next().unwrap()));
    assert_eq!(frames.count(), 20);
}

/// Whether an input is an image, kept by value.
fn is_frame(input: &Record<'_>) -> bool {
    matches!(input, Record::Input(Input::Message { payload: Payload::Value(cdr), .. }) if cdr.len() > 1_000_000)
}

#[test]
fn golden_journals_are_small_and_name_no_machine() {
    let mut bytes = 0;
    for run in golden_runs() {
        for path in journals(&golden(&run)) {
            bytes += path.metadata().unwrap().len();
            for file in &JournalReader::open(&path).unwrap().start().files {
                assert!(file.path.starts_with("/tmp/trench-golden/"), "{}", file.path);
            }
        }
    }
    assert!(bytes < 6 << 20, "{bytes} bytes");
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

#[test]
fn journals_beside_a_bag_that_was_not_finished_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let (bag, journals) = (folder.path().join("bag"), folder.path().join("journals"));
    std::fs::create_dir(&bag).unwrap();
    std::fs::create_dir(&journals).unwrap();
    // A recorder that was killed leaves no metadata.yaml.
    std::fs::write(bag.join("bag_0.mcap"), b"\x89MCAP0\r\n").unwrap();
    std::fs::copy(golden("triangle").join("rf_bridge.mcap"), journals.join("rf_bridge.mcap")).unwrap();
    let (code, said) = check(&[], &bag);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("/rf_bridge"), "{said}");
}
