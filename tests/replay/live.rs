//! A run of processes in real time, checked from the journals they kept.

use super::check;
use std::path::Path;
use std::process::Command;
use std::time::Duration;
use trench_harness::replay::{Verdict, replay};
use trench_journal::JournalReader;

/// How many squares are launched and checked: `TRENCH_LIVE_RUNS`, one by default.
fn runs() -> u32 {
    std::env::var("TRENCH_LIVE_RUNS").map_or(1, |text| text.parse().unwrap())
}

/// Launches the square for so many seconds, with a bag, and gives what it said.
fn launch(folder: &Path, domain: u32, seconds: f64, arguments: &[&str]) -> String {
    let domain = domain_number(domain);
    let output = Command::new(super::programs::trench())
        .arg("launch")
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("launch/square.launch.yaml"))
        .arg(format!("duration:={seconds:?}"))
        .args(["tolerance:=3.0", "record:=true"])
        .arg(format!("bag:={}", folder.join("bag").display()))
        .arg(format!("port:={}", folder.join("port").display()))
        .arg("--run-dir")
        .arg(folder.join("run"))
        .args(arguments)
        .env("ROS_DOMAIN_ID", domain.to_string())
        .env("TRENCH_SHM_PREFIX", shared_memory(domain))
        .env("TRENCH_STATE_DIR", folder.join("state"))
        .output()
        .unwrap();
    trench_runtime::forget_shared_memory(&shared_memory(domain)).unwrap();
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// A domain of these tests alone; real-time tests run one at a time. Those up to 101 have ports that the kernel gives
/// to nobody else.
fn domain_number(offset: u32) -> u32 {
    71 + (std::process::id() % 7) * 4 + offset
}

/// The prefix of the shared memory of a launch in this domain.
fn shared_memory(domain: u32) -> String {
    format!("replay{domain}_{}_", std::process::id())
}

#[test]
fn live_every_node_of_a_square_replays_bit_for_bit() {
    for run in 1..=runs() {
        let folder = tempfile::tempdir().unwrap();
        let launched = launch(folder.path(), 0, 10.0, &["--journal=images", &format!("seed:={run}")]);
        let (code, said) = check(&[], &folder.path().join("bag"));
        println!("run {run}\n{said}");
        assert_eq!(code, Some(0), "run {run}: {said}\n{launched}");
        assert_eq!(said.matches("  equal\n").count(), 10, "run {run}: {said}");
    }
    println!("all {} runs equal", runs());
}

#[test]
fn live_without_images_all_but_the_localizer_can_be_checked() {
    let folder = tempfile::tempdir().unwrap();
    let launched = launch(folder.path(), 1, 6.0, &["--journal"]);
    let (code, said) = check(&[], &folder.path().join("bag"));
    assert_eq!(code, Some(2), "{said}\n{launched}");
    assert_eq!(said.matches("  equal\n").count(), 9, "{said}\n{launched}");
    assert!(said.contains("/overhead/image_raw: images were not journalled"), "{said}");
}

#[test]
fn live_a_killed_node_loses_less_than_a_second() {
    let folder = tempfile::tempdir().unwrap();
    let domain = domain_number(2);
    let mut node = Command::new(Path::new(env!("CARGO_BIN_EXE_trench")).with_file_name("rf_bridge"))
        .args(["--ros-args", "-p", "robots:=[robot1]", "-p"])
        .arg(format!("serial.port:={}", folder.path().join("port").display()))
        .env("ROS_DOMAIN_ID", domain.to_string())
        .env("TRENCH_SHM_PREFIX", shared_memory(domain))
        .env("TRENCH_STATE_DIR", folder.path().join("state"))
        .env("TRENCH_JOURNAL_DIR", folder.path().join("journals"))
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_secs(4));
    let killed_at = rustix::time::clock_gettime(rustix::time::ClockId::Monotonic);
    node.kill().unwrap();
    node.wait().unwrap();
    trench_runtime::forget_shared_memory(&shared_memory(domain)).unwrap();

    let journal = JournalReader::open(&folder.path().join("journals/rf_bridge.mcap")).unwrap();
    let last = journal.steps().filter_map(Result::ok).last().unwrap();
    let lost = killed_at.tv_sec as f64 + killed_at.tv_nsec as f64 * 1e-9 - last.at.steady.0 as f64 * 1e-9;
    assert!(lost < 1.0, "{lost} s");
    println!("{lost:.3} s lost");
    let Verdict::NotReplayable { from, reason } = replay(&journal).unwrap().verdict else { panic!("it has no end") };
    assert!(from > 1.0 && reason.contains("its process was killed"), "{from}: {reason}");
}
