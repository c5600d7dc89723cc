//! Nodes on several hosts (network namespaces): over DDS on one bridge, and over Zenoh through a router between two
//! networks that nothing else crosses. Each message once and in order, the past of latched topics, services, and one
//! clock for all.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[cfg(test)]
#[path = "../common/mod.rs"]
mod common;
#[cfg(test)]
mod network;
#[cfg(test)]
mod slow;

use common::{Island, Running};
use network::{Host, World};
use std::process::Command;
use tempfile::TempDir;

/// Two hosts and how their nodes reach each other.
struct Pair {
    island: Island,
    west: Host,
    east: Host,
    west_overrides: String,
    east_overrides: String,
    rmw: &'static str,
    folder: TempDir,
    /// What joins them, and the world that goes last.
    routers: Vec<Running>,
    /// The network of the first of them.
    network: String,
    _world: World,
}

impl Pair {
    /// On one bridge, over DDS.
    fn on_a_bridge(number: u16) -> Option<Self> {
        let mut world = world(number)?;
        let bridge = world.network("net");
        let west = world.host("west", &[(&bridge, "10.77.0.1/24")]);
        let east = world.host("east", &[(&bridge, "10.77.0.2/24")]);
        let island = Island::new(number);
        let none = String::new;
        let rmw = "rmw_fastrtps_cpp";
        Some(Self {
            island,
            west,
            east,
            west_overrides: none(),
            east_overrides: none(),
            rmw,
            folder: tempfile::tempdir().unwrap(),
            routers: Vec::new(),
            network: bridge,
            _world: world,
        })
    }

    /// In two networks with a Zenoh router between them.
    fn beside_a_router(number: u16) -> Option<Self> {
        let mut world = world(number)?;
        let (one, other) = (world.network("one"), world.network("other"));
        let gate = world.host("gate", &[(&one, "10.78.0.254/24"), (&other, "10.79.0.254/24")]);
        let west = world.host("west", &[(&one, "10.78.0.1/24")]);
        let east = world.host("east", &[(&other, "10.79.0.1/24")]);
        assert!(west.reaches("10.78.0.254") && east.reaches("10.79.0.254"), "the networks do not work");
        assert!(!west.reaches("10.79.0.1"), "the networks are joined: the router proves nothing");
        let island = Island::new(number);
        let mut router = gate.move_to(&island.command("router", ""));
        router.env_remove("ZENOH_CONFIG_OVERRIDE");
        let router = Island::run(router);
        let locators = router.line();
        assert!(locators.contains(":7447"), "{locators}");
        let through = |gate: &str| {
            format!(
                "mode=\"client\";listen/endpoints=[];connect/timeout_ms=30000;connect/endpoints=[\"tcp/{gate}:7447\"]"
            )
        };
        let (west_overrides, east_overrides) = (through("10.78.0.254"), through("10.79.0.254"));
        let rmw = "rmw_zenoh_cpp";
        Some(Self {
            island,
            west,
            east,
            west_overrides,
            east_overrides,
            rmw,
            folder: tempfile::tempdir().unwrap(),
            routers: vec![router],
            network: one,
            _world: world,
        })
    }

    /// On one bridge, with a Zenoh router on each host, set up by these assignments.
    fn with_routers(number: u16, western: &str, eastern: &str) -> Option<Self> {
        let mut pair = Self::on_a_bridge(number)?;
        pair.rmw = "rmw_zenoh_cpp";
        for (host, overrides) in [(&pair.west, western), (&pair.east, eastern)] {
            let mut router = host.move_to(&pair.island.command("router", ""));
            router.env("ZENOH_CONFIG_OVERRIDE", overrides);
            let router = Island::run(router);
            assert!(router.line().contains(":7447"), "the router does not listen");
            pair.routers.push(router);
        }
        Some(pair)
    }

    fn at(&self, host: &Host, overrides: &str, example: &str, arguments: &str) -> Running {
        self.run_at(host, overrides, &self.island.command(example, arguments))
    }

    fn run_at(&self, host: &Host, overrides: &str, command: &Command) -> Running {
        let mut command = host.move_to(command);
        // Hosts share no memory; the namespaces of one kernel would.
        command.env("TRENCH_SHM_PREFIX", format!("{}{}", host.name(), std::process::id()));
        command.env("RMW_IMPLEMENTATION", self.rmw).env("ZENOH_CONFIG_OVERRIDE", overrides);
        Island::run(command)
    }

    /// On the east host, with a wall clock that is so many hours ahead of everybody else's (tests/faults/wall_clock.c): of the
    /// clocks that time namespaces offset it is none.
    fn east_hours_ahead(&self, hours: i64, example: &str, arguments: &str) -> Running {
        let (library, offset) = (self.folder.path().join("wall_clock.so"), self.folder.path().join("east.clock"));
        let source = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/faults/wall_clock.c");
        let compiled = Command::new("cc").args(["-shared", "-fPIC", "-O2", "-o"]).arg(&library).arg(source).status();
        assert!(compiled.unwrap().success(), "{source} does not compile");
        std::fs::write(&offset, (hours * 3_600_000_000_000).to_le_bytes()).unwrap();
        let mut command = self.island.command(example, arguments);
        command.env("LD_PRELOAD", library).env("WALL_CLOCK", offset);
        self.run_at(&self.east, &self.east_overrides, &command)
    }

    fn west(&self, example: &str, arguments: &str) -> Running {
        self.at(&self.west, &self.west_overrides, example, arguments)
    }

    fn east(&self, example: &str, arguments: &str) -> Running {
        self.at(&self.east, &self.east_overrides, example, arguments)
    }
}

impl Drop for Pair {
    fn drop(&mut self) {
        for host in [&self.west, &self.east] {
            trench_runtime::forget_shared_memory(&format!("{}{}", host.name(), std::process::id())).unwrap();
        }
    }
}

/// A world of hosts; nothing, with the reason printed, where this user may not make one.
fn world(number: u16) -> Option<World> {
    World::new(number).map_err(|problem| println!("SKIPPED: no network namespaces here: {problem}")).ok()
}

fn next(listener: &Running) -> u64 {
    let line = listener.line();
    let (sequence, text) = line.split_once(' ').unwrap();
    assert_eq!(sequence, text.trim());
    sequence.parse().unwrap()
}

fn nodes_of_two_hosts_understand_each_other(pair: &Pair) {
    // Somebody who is on neither host.
    let stranger = pair.island.start("listener", "");
    // Each once and in order.
    let listener = pair.east("listener", "");
    let talker = pair.west("talker", "--ros-args -p rate:=200.0");
    let mut last = next(&listener);
    for _ in 0..1000 {
        let count = next(&listener);
        assert_eq!(count, last + 1, "a message is missing or came twice");
        last = count;
    }
    // A service of the other host.
    let caller = pair.east("caller", "");
    assert_eq!(caller.line(), "counting from 1");
    assert_eq!(caller.end().0, 0);
    drop((listener, talker));
    // The past of a latched topic.
    let latched = "--ros-args -p rate:=1000.0 -p pause_after:=50 -p latched:=true --log-level debug";
    let silent = pair.west("talker", latched);
    silent.wait_for_log("said 50");
    let late = pair.east("listener", "--ros-args -p latched:=true");
    assert_eq!(next(&late), 50);
    stranger.signal("INT");
    assert_eq!(stranger.end().1, Vec::<String>::new(), "the hosts are not apart");
}

fn the_clock_of_the_other_host_is_ros_time(pair: &Pair) {
    // Without its reference a node's time stands at zero.
    let east =
        pair.east("talker", "--ros-args -r __node:=robot -p clock_reference:=/base -p rate:=2.0 --log-level debug");
    east.wait_for_log("[DEBUG] [0.000000000] [robot]: said 1");
    let hears = pair.west("diagnostics", "");
    let report = hears.line();
    assert!(
        report.contains("level 2") && report.contains("/robot: clock: the clock of /base is not known yet"),
        "{report}"
    );
    let _base = pair.west("talker", "--ros-args -r __node:=base -p serve_clock:=true -p rate:=2.0");
    // The namespaces of one kernel have one clock: whatever was measured, zero is within its bound.
    let (offset, bound) = loop {
        let report = hears.line();
        assert!(report.contains("/robot: clock"), "{report}");
        if let Some((offset, bound)) = report.split_once("offset ").and_then(|(_, rest)| rest.split_once(" known to "))
        {
            break (offset.parse::<f64>().unwrap(), bound.parse::<f64>().unwrap());
        }
    };
    println!("offset {offset} s, known to {bound} s");
    assert!(offset.abs() <= bound, "offset {offset} s, known to {bound} s");
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap().as_secs();
    // Ten digits of seconds, of which the first seven are the same for a quarter of an hour.
    east.wait_for_log(&format!("[DEBUG] [{}", &now.to_string()[..6]));
}

/// What `/robot` reports of its clock, offset and bound in s, once it knows.
fn reported_offset(hears: &Running) -> (f64, f64) {
    loop {
        let report = hears.line();
        let Some((offset, bound)) = report.split_once("offset ").and_then(|(_, rest)| rest.split_once(" known to "))
        else {
            continue;
        };
        return (offset.parse().unwrap(), bound.parse().unwrap());
    }
}

fn a_clock_that_is_hours_off_is_measured(pair: &Pair) {
    let _base = pair.west("talker", "--ros-args -r __node:=base -p serve_clock:=true -p rate:=2.0");
    for hours in [1, -1] {
        let hears = pair.west("diagnostics", "");
        let talks = "--ros-args -r __node:=robot -p clock_reference:=/base -p rate:=2.0 --log-level debug";
        let east = pair.east_hours_ahead(hours, "talker", talks);
        let (offset, bound) = reported_offset(&hears);
        let truth = 3600.0 * hours as f64;
        println!("{hours} h: offset {offset} s, known to {bound} s");
        assert!((offset - truth).abs() <= bound, "offset {offset} s, known to {bound} s, it is {truth} s");
        assert!(bound < 1.0, "known to {bound} s");
        // Its ROS time is the base's.
        let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap().as_secs();
        east.wait_for_log(&format!("[DEBUG] [{}", &now.to_string()[..8]));
        drop(east);
    }
}

/// One test a network for each of these checks.
macro_rules! on_every_network {
    ($($check:ident $number:literal)*) => {
        #[cfg(test)]
        mod over_dds {
            $(#[test] fn $check() { if let Some(pair) = super::Pair::on_a_bridge($number) { super::$check(&pair) } })*
        }
        #[cfg(test)]
        mod over_zenoh {
            $(#[test] fn $check() { if let Some(pair) = super::Pair::beside_a_router($number + 1) { super::$check(&pair) } })*
        }
    };
}
on_every_network! {
    nodes_of_two_hosts_understand_each_other 40
    the_clock_of_the_other_host_is_ros_time 42
    a_clock_that_is_hours_off_is_measured 44
}
