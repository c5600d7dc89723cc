//! A bag that `rosbags` wrote is played into the stack: a node of ours hears it, and so does the recorder.

use super::{Island, Running, wait_until};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;
use trench_bag::BagReader;

/// Writes the bag with rosbags, of `scripts/ros-venv`.
fn write(bag: &Path, count: usize) {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR"));
    let venv = std::env::var_os("TRENCH_VENV").map_or_else(|| repository.join(".venv"), PathBuf::from);
    let script = repository.join("tests/interop/bag_write_rosbags.py");
    let mut python = Command::new(venv.join("bin/python3"));
    let output = python.arg(script).arg(bag).arg(count.to_string()).arg("/emergency_stop").output();
    let output = output.unwrap_or_else(|error| panic!("{}: {error}; run scripts/ros-venv", venv.display()));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn live_a_bag_of_rosbags_stops_the_bridge() {
    let island = Island::new(3);
    let (theirs, ours, log) = (island.path("theirs"), island.path("ours"), island.path("log"));
    write(&theirs, 100);
    let file = File::create(&log).unwrap();
    let mut bridge = island.command("rf_bridge");
    bridge.args(["--ros-args", "-p", "robots:=[robot1]", "-p"]);
    bridge
        .arg(format!("serial.port:={}", island.path("port").display()))
        .stdout(file.try_clone().unwrap())
        .stderr(file);
    let _bridge = Running::start(&mut bridge);
    let arguments = ["record", ours.to_str().unwrap(), "--topics", "/emergency_stop"];
    let recorder = Running::start(&mut island.bag(&arguments));
    wait_until("the recorder is there", || ours.exists());
    // Before the player begins all know each other.
    assert!(island.bag(&["play", theirs.to_str().unwrap(), "--delay", "5"]).status().unwrap().success());
    wait_until("the bridge heard the stop", || {
        fs::read_to_string(&log)
            .unwrap()
            .lines()
            .any(|line| line.contains("rf_bridge") && line.ends_with("emergency stop"))
    });
    assert!(recorder.interrupt());
    let bytes = |bag: &Path| -> Vec<Vec<u8>> {
        BagReader::open(bag).unwrap().messages().map(|message| message.unwrap().to_vec()).collect()
    };
    let (sent, heard) = (bytes(&theirs), bytes(&ours));
    assert_eq!((sent.len(), &heard), (100, &sent), "each message once, byte for byte");
}
