//! A link of 256 kbit/s that carries images beside commands: fifty commands a second are as young as they must be, and images
//! come as often as there is room. Commands are read as they come (`read_best_effort`): what DDS repeats on such a link
//! is old when it comes and holds up what is new.

use super::Pair;
use std::process::Command;

/// us, within which 99 of 100 commands come: of the 0.25 s that information may be old, camera, vision and control take 45 ms,
/// the bridge and the air 60.
const COMMAND: u64 = 145_000;

/// What Zenoh routers need on a slow link: little lies between the queues of who sends, in which what is urgent goes first, and the
/// wire. Who sends listens: its sockets are then served by threads that never wait for them.
const LISTENS: &str = "transport/link/tx/batch_size=600;transport/link/tx/queue/size/data=4;listen/endpoints=[\"tcp/[::]:7447\",\"tcp/[::]:7448#so_sndbuf=1\"]";
const CONNECTS: &str = "connect/endpoints=[\"tcp/10.77.0.1:7448#so_rcvbuf=4096\"]";

/// 99 of 100 messages are younger, us.
fn p99(said: &str) -> u64 {
    let (_, rest) = said.split_once("p99 ").unwrap();
    rest.split_once(" us").unwrap().0.parse().unwrap()
}

/// Commands and images from west to east; images take `rate` of the network.
fn commands_are_young_beside_images(pair: &Pair, rate: &str) {
    let command = "--ros-args -r /stamps:=/commands -p bytes:=80 -p rate:=50.0";
    let image = "--ros-args -r /stamps:=/images -p bytes:=9240 -p rate:=10.0 -p best_effort:=true";
    let source = "-p role:=source -p shared_memory:=false";
    // What nodes tell one another when they meet fills such a link for some seconds.
    let images = pair.east("latency", &format!("{image} -p count:=10 -r __node:=eye"));
    let taken = "-p read_best_effort:=[\"*\"]";
    let commands = pair.east("latency", &format!("{command} {taken} -p skip:=300 -p count:=400 -r __node:=wheels"));
    let _camera = pair.west("latency", &format!("{image} {source} -p network_rate:={rate} -r __node:=camera"));
    let _controller = pair.west("latency", &format!("{command} {source} -r __node:=controller"));
    let (commands, images) = (commands.line(), images.line());
    println!("commands {commands}; images {images}");
    assert!(p99(&commands) <= COMMAND, "commands {commands}; images {images}");
}

/// Adds a queue to a network or a host.
fn tc(namespace: &str, queue: &[&str]) {
    let output = Command::new("tc").args(["-n", namespace, "qdisc", "add"]).args(queue).output().unwrap();
    assert!(output.status.success(), "tc {}: {}", queue.join(" "), String::from_utf8_lossy(&output.stderr));
}

/// From now on no more than 256 kbit/s go to the eastern host, in the order in which they come; a fifth of a second of it waits, what
/// exceeds that is lost.
fn slow_down_the_way(pair: &Pair) {
    let bucket = ["tbf", "rate", "256kbit", "burst", "1600", "limit", "6400"];
    tc(&pair.network, &[&["dev", "to-east", "root"], &bucket[..]].concat());
}

/// From now on no more than 256 kbit/s leave the western host; what its processes call urgent first, as any Linux has it.
fn slow_down_the_interface(pair: &Pair) {
    let bucket = ["handle", "1:", "tbf", "rate", "256kbit", "burst", "1600", "latency", "10s"];
    tc(pair.west.name(), &[&["dev", "eth0", "root"], &bucket[..]].concat());
    tc(pair.west.name(), &["dev", "eth0", "parent", "1:1", "handle", "10:", "pfifo_fast"]);
}

/// The slow link is beyond the host, and knows no urgency: images keep to their rate, piece by piece.
#[test]
fn live_over_dds_images_leave_room_on_a_link_that_knows_no_urgency() {
    let Some(pair) = Pair::on_a_bridge(44) else { return };
    slow_down_the_way(&pair);
    commands_are_young_beside_images(&pair, "100000.0");
}

/// The slow link is the host's own, as Wi-Fi often is: its queue lets commands pass, and images take what is left.
#[test]
fn live_over_dds_images_let_commands_pass_at_the_host_s_own_interface() {
    let Some(pair) = Pair::on_a_bridge(45) else { return };
    slow_down_the_interface(&pair);
    commands_are_young_beside_images(&pair, "400000000.0");
}

/// Between the routers of two hosts all goes through one connection.
#[test]
fn live_over_zenoh_images_let_commands_pass_between_routers() {
    let Some(pair) = Pair::with_routers(46, LISTENS, CONNECTS) else { return };
    slow_down_the_way(&pair);
    commands_are_young_beside_images(&pair, "100000.0");
}
