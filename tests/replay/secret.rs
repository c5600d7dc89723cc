//! Journals of nodes that know a key do not hold it, and are replayed by whoever has it.

use super::{check, journals};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

const KEY: &str = "00f1e2d3c4b5a69788796a5b4c3d2e1f";

fn write(path: &Path, key: &str, mode: u32) {
    std::fs::write(path, key).unwrap();
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(mode)).unwrap();
}

/// A second of the square with this key, journalled.
fn sim(key: &Path, to: &Path) -> (Option<i32>, String) {
    let Output { status, stderr, .. } = Command::new(env!("CARGO_BIN_EXE_trench"))
        .args(["sim", "launch/square.launch.yaml", "duration:=1.0", "tolerance:=3.0", "--quiet", "--journal"])
        .arg(to)
        .arg(format!("key:={}", key.display()))
        .output()
        .unwrap();
    (status.code(), String::from_utf8_lossy(&stderr).into_owned())
}

#[test]
fn a_key_is_in_no_journal_and_bridges_replay_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let (key, kept) = (folder.path().join("key"), folder.path().join("journals"));
    write(&key, KEY, 0o600);
    let (code, said) = sim(&key, &kept);
    assert_eq!(code, Some(0), "{said}");
    for path in journals(&kept) {
        let journal = trench_journal::JournalReader::open(&path).unwrap();
        assert!(!format!("{:?}", journal.start()).contains(KEY), "{}", path.display());
    }
    let node = ["--node", "/rf_bridge"];
    let (code, said) = check(&node, &kept);
    assert!(code == Some(0) && said.contains("  equal\n"), "{said}");

    write(&key, "00f1e2d3c4b5a69788796a5b4c3d2e10", 0o600);
    let (code, said) = check(&node, &kept);
    assert!(code != Some(0) && said.contains("holds another secret than when the journal was recorded"), "{said}");
    std::fs::remove_file(&key).unwrap();
    let (code, said) = check(&node, &kept);
    assert!(code != Some(0) && said.contains("key_file") && said.contains("cannot be read"), "{said}");
}

#[test]
fn a_key_that_others_may_read_starts_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let key = folder.path().join("key");
    write(&key, KEY, 0o644);
    let (code, said) = sim(&key, &folder.path().join("journals"));
    assert!(code != Some(0) && said.contains("key_file") && said.contains("0644"), "{code:?}: {said}");
    assert!(said.contains(&format!("chmod 600 {}", key.display())), "{said}");
}
