//! A foreign implementation of rmw_zenoh's protocol (zenoh-ros2-sdk, from scripts/ros-venv) against our nodes over Zenoh:
//! it sees the graph, hears messages and the past of latched topics, is heard, and is answered.

#[cfg(test)]
mod common;
#[cfg(test)]
#[path = "conformance/router.rs"]
mod router;

use common::{Island, Running};
use std::path::{Path, PathBuf};
use std::process::Command;
use trench_msgs::std_msgs::String as Text;
use trench_msgs::std_srvs::Trigger;
use trench_msgs::{Message, Service};

/// The peer's program with these arguments, on an island.
fn peer(island: &Island, arguments: &[&str]) -> Running {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let venv = std::env::var_os("TRENCH_VENV").map_or_else(|| root.join(".venv"), PathBuf::from);
    let python = venv.join("bin/python3");
    assert!(python.exists(), "{} is no virtual environment: run scripts/ros-venv", venv.display());
    let ours = island.command("talker", "");
    let mut command = Command::new(python);
    command.arg(root.join("tests/interop/peer_zenoh.py")).args(arguments);
    for (name, value) in ours.get_envs().filter_map(|(name, value)| Some((name, value?))) {
        command.env(name, value);
    }
    command.stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::piped());
    Island::run(command)
}

#[test]
fn interop_zenoh_peers_see_nodes_topics_and_services() {
    let island = Island::with_router(45);
    let talker = island.start("talker", "--ros-args -r __ns:=/hall -p rate:=100.0 --log-level debug");
    talker.wait_for_log("said 5");
    let graph = peer(&island, &["graph"]).line();
    for part in [
        "\"nodes\": [\"/hall/talker\"]",
        "\"/chatter\": [\"std_msgs/msg/String\"]",
        "\"/rosout\": [\"rcl_interfaces/msg/Log\"]",
        "\"/parameter_events\": [\"rcl_interfaces/msg/ParameterEvent\"]",
        "\"/hall/talker/reset\": [\"std_srvs/srv/Trigger\"]",
        "\"/hall/talker/get_parameters\": [\"rcl_interfaces/srv/GetParameters\"]",
    ] {
        assert!(graph.contains(part), "`{part}` is not in {graph}");
    }
}

#[test]
fn interop_zenoh_peers_hear_messages_and_the_past_of_latched_topics() {
    let island = Island::with_router(46);
    let talker =
        island.start("talker", "--ros-args -p latched:=true -p rate:=1000.0 -p pause_after:=50 --log-level debug");
    talker.wait_for_log("said 50");
    // Our own late reader gets it beyond the router, so the peer can.
    let witness = island.start("listener", "--ros-args -p latched:=true");
    let heard = witness.line();
    assert!(heard.ends_with(" 50"), "{heard}");
    let echo = ["echo", "/chatter", Text::TYPE.name, Text::TYPE.hash];
    let late = peer(&island, &[&echo[..], &["--latched"]].concat());
    assert_eq!(late.line(), "{\"data\": \"50\"}");
    let lively = island.start("talker", "--ros-args -r __node:=lively -p rate:=20.0");
    let first = late.line();
    assert!(first.starts_with("{\"data\": \""), "{first}");
    drop(lively);
}

#[test]
fn interop_zenoh_peers_are_heard() {
    let island = Island::with_router(47);
    let listener = island.start("listener", "");
    let _peer = peer(&island, &["publish", "/chatter", Text::TYPE.name, Text::TYPE.hash, "{\"data\": \"7\"}"]);
    for _ in 0..10 {
        let line = listener.line();
        assert!(line.ends_with(" 7"), "{line}");
    }
}

#[test]
fn interop_zenoh_peers_are_answered() {
    let island = Island::with_router(48);
    let talker = island.start("talker", "--ros-args -p rate:=100.0 --log-level debug");
    talker.wait_for_log("said 5");
    let asker = peer(&island, &["trigger", "/talker/reset", Trigger::HASH]);
    assert_eq!(asker.line(), "{\"success\": true, \"message\": \"counting from 1\"}");
    talker.signal("INT");
    assert_eq!(talker.end().0, 0);
}
