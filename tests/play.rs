//! Bags played by one process and recorded by another.
#![expect(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

#[path = "support/own_memory.rs"]
mod own_memory;

use own_memory::OwnMemory;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use trench_bag::{BagReader, BagWriter, Stamp, TopicType, WriteOptions};
use trench_core::Qos;
use trench_msgs::msg::RunState;
use trench_msgs::{Encode, Message, std_msgs};

/// A type that no program here was built with.
const FOREIGN: TopicType<'static> =
    TopicType { name: "theirs/msg/Thing", hash: "RIHS01_00", definition: "float64 data\n" };

/// Writes a second of three topics: a latched one, one of 100 Hz, and one of a foreign type.
fn write(bag: &Path) -> usize {
    let mut writer = BagWriter::create(bag, WriteOptions::default()).unwrap();
    let state = writer.add_topic("/run_state", RunState::TYPE.into(), Qos::LATCHED).unwrap();
    let number = writer.add_topic("/number", std_msgs::Float64::TYPE.into(), Qos::RELIABLE).unwrap();
    let thing = writer.add_topic("/thing", FOREIGN, Qos::RELIABLE).unwrap();
    let stamp = |index: u64| {
        let log_time = 1_700_000_000_000_000_000 + index * 10_000_000;
        Stamp { log_time, publish_time: log_time, sequence: index as u32 }
    };
    writer.write(state, stamp(0), &RunState::default().to_cdr()).unwrap();
    for index in 0..100 {
        writer.write(number, stamp(index), &std_msgs::Float64 { data: index as f64 }.to_cdr()).unwrap();
        writer.write(thing, stamp(index), &std_msgs::Float64 { data: -(index as f64) }.to_cdr()).unwrap();
    }
    writer.finish().unwrap();
    201
}

fn messages(bag: &BagReader, topic: &str) -> Vec<(u64, Vec<u8>)> {
    let Some(index) = bag.topic(topic) else { return Vec::new() };
    let all = bag.messages().map(Result::unwrap).filter(|message| message.topic == index);
    all.map(|message| (message.log_time, message.to_vec())).collect()
}

#[test]
fn live_what_is_played_is_discovered_and_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let (original, copy) = (folder.path().join("original"), folder.path().join("copy"));
    let count = write(&original);
    // Up to 101: the ports of domains above may be in use by anyone.
    let domain = (89 + std::process::id() % 10).to_string();
    let memory = OwnMemory(format!("play{}_", std::process::id()));
    let trench = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trench"));
        command.arg("bag").args(arguments).stdin(Stdio::null());
        command.env("ROS_DOMAIN_ID", &domain).env("TRENCH_SHM_PREFIX", &memory.0);
        command.env("TRENCH_STATE_DIR", folder.path().join("state"));
        command
    };
    let path = copy.to_str().unwrap();
    let mut recorder = trench(&["record", path, "--regex", "^/(run_state|number|thing)$"]).spawn().unwrap();
    let deadline = Instant::now() + Duration::from_secs(20);
    while !copy.exists() {
        assert!(Instant::now() < deadline, "the recorder does not start");
        std::thread::sleep(Duration::from_millis(20));
    }
    let player = trench(&["play", original.to_str().unwrap(), "--delay", "4"]).status().unwrap();
    assert!(player.success());
    std::thread::sleep(Duration::from_millis(500));
    let process = rustix::process::Pid::from_child(&recorder);
    rustix::process::kill_process(process, rustix::process::Signal::INT).unwrap();
    assert!(recorder.wait().unwrap().success());

    let (original, copy) = (BagReader::open(&original).unwrap(), BagReader::open(&copy).unwrap());
    assert_eq!((copy.damage(), copy.message_count()), (&[][..], count as u64), "each message once");
    for topic in original.topics() {
        let (sent, got) = (messages(&original, &topic.name), messages(&copy, &topic.name));
        assert!(sent.iter().map(|m| &m.1).eq(got.iter().map(|m| &m.1)), "{}: the bytes are the same", topic.name);
        let found = &copy.topics()[copy.topic(&topic.name).unwrap()];
        assert_eq!((&found.type_name, found.qos().durability), (&topic.type_name, topic.qos().durability));
    }
    let foreign = &copy.topics()[copy.topic("/thing").unwrap()];
    assert_eq!(foreign.definition, "", "nobody here knows it");
}
