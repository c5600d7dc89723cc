//! Topics: order, exactly once, latched and large messages, restarts and deaths.

use crate::common::Running;
use crate::{LOCAL, Network, on_every_network};
use std::time::Duration;

on_every_network! {
    order_and_exactly_once_at_speed
    a_late_joiner_gets_the_last_latched_message_first
    large_messages_arrive_whole
    a_writer_that_dies_is_followed_by_the_next
    a_reader_that_restarts_goes_on_without_copies_or_gaps
    messages_that_do_not_wake_come_with_the_next_event
    a_foreign_type_is_reported_and_not_read
    memory_does_not_grow_with_what_was_heard
    who_was_stopped_goes_on_to_speak_and_to_hear
}

/// Sequence numbers and texts of the listener's next lines.
fn heard(listener: &Running, count: usize) -> Vec<(u64, u64)> {
    (0..count).map(|_| parse(&listener.line())).collect()
}

fn parse(line: &str) -> (u64, u64) {
    let (sequence, text) = line.split_once(' ').unwrap();
    (sequence.parse().unwrap(), text.trim().parse().unwrap())
}

/// Each message once, in order, none missing.
fn assert_complete(heard: &[(u64, u64)]) {
    for pair in heard.windows(2) {
        assert_eq!(pair[1].0, pair[0].0 + 1, "sequence numbers: {pair:?}");
        assert_eq!(pair[1].1, pair[0].1 + 1, "texts: {pair:?}");
    }
}

fn order_and_exactly_once_at_speed(network: Network) {
    network.on_every_way(0, |island, local| {
        let listener = island.start("listener", "");
        let talker = island.start("talker", &format!("--ros-args -p rate:=2000.0 -p local:={local}"));
        let heard = heard(&listener, 4000);
        drop(talker);
        assert_complete(&heard);
    });
}

fn a_late_joiner_gets_the_last_latched_message_first(network: Network) {
    network.on_every_way(1, |island, local| {
        let talker = island
            .start("talker", &format!("--ros-args -p rate:=0.3 -p latched:=true -p local:={local} --log-level debug"));
        talker.wait_for_log("said 2");
        let listener = island.start("listener", "--ros-args -p latched:=true");
        let heard = heard(&listener, 2);
        assert!(heard[0].1 >= 2, "{heard:?}");
        assert_complete(&heard);
    });
}

/// Over DDS it may get more: decision 1 says why.
#[test]
fn a_late_joiner_over_zenoh_gets_no_more_of_the_past_than_the_depth() {
    let island = Network::Zenoh.island(15);
    // 200 messages in a fifth of a second, and silence.
    let talker =
        island.start("talker", "--ros-args -p rate:=1000.0 -p pause_after:=200 -p latched:=true --log-level debug");
    talker.wait_for_log("said 200");
    for _late in 0..2 {
        let listener = island.start("listener", "--ros-args -p latched:=true");
        assert_eq!(parse(&listener.line()), (200, 200), "the newest, and nothing before it");
        listener.signal("INT");
        let (_, rest, _) = listener.end();
        assert_eq!(rest, Vec::<String>::new());
    }
}

fn large_messages_arrive_whole(network: Network) {
    for (number, (local, padding)) in LOCAL.into_iter().zip([200_000, 200_000, 1_327_104]).enumerate() {
        let island = network.island(6 + number as u16);
        let listener = island.start("listener", "");
        let arguments = format!("--ros-args -p rate:=10.0 -p padding:={padding} -p local:={local}");
        let _talker = island.start("talker", &arguments);
        assert_complete(&heard(&listener, 10));
    }
}

fn a_writer_that_dies_is_followed_by_the_next(network: Network) {
    network.on_every_way(3, |island, local| {
        let listener = island.start("listener", "");
        for _life in 0..3 {
            let talker = island.start("talker", &format!("--ros-args -p rate:=500.0 -p local:={local}"));
            // What the last life left behind it comes first; then one that counts anew.
            let first = loop {
                let (sequence, text) = parse(&listener.line());
                // To the network alone messages are not sent, nor counted, before somebody reads them.
                assert!(if local == "network" { sequence <= text } else { sequence == text }, "{sequence} {text}");
                if sequence < 400 {
                    break (sequence, text);
                }
            };
            let mut heard = heard(&listener, 500);
            heard.insert(0, first);
            assert_complete(&heard);
            talker.signal("KILL");
            assert_eq!(talker.end().0, 128 + 9);
        }
    });
}

fn a_reader_that_restarts_goes_on_without_copies_or_gaps(network: Network) {
    network.on_every_way(4, |island, local| {
        let _talker = island.start("talker", &format!("--ros-args -p rate:=500.0 -p local:={local}"));
        let mut last = 0;
        for ending in ["KILL", "INT", "KILL"] {
            let listener = island.start("listener", "");
            let heard = heard(&listener, 300);
            assert_complete(&heard);
            assert!(heard[0].0 > last, "a message of an earlier life: {:?}", heard[0]);
            last = heard[299].0;
            listener.signal(ending);
            listener.end();
        }
    });
}

fn messages_that_do_not_wake_come_with_the_next_event(network: Network) {
    for (number, local) in LOCAL.iter().enumerate() {
        let island = network.island(26 + number as u16);
        let listener = island.start("listener", "--ros-args -p wakes:=false -p period:=0.5");
        let _talker = island.start("talker", &format!("--ros-args -p rate:=200.0 -p local:={local}"));
        // Twenty wake-ups a second or more would have been needed to hear them one by one.
        let mut batches = Vec::new();
        while batches.len() < 4 {
            match listener.line().split_once(' ') {
                Some(("wakeup", heard)) => batches.push(heard.parse::<usize>().unwrap()),
                Some(_) => {}
                None => panic!("neither a wake-up nor a message"),
            }
        }
        // The first ones may be empty: writer and reader have not met.
        assert!(batches[3] - batches[2] > 20, "{batches:?} over {local}");
    }
}

fn a_foreign_type_is_reported_and_not_read(network: Network) {
    let island = network.island(35);
    let listener = island.start("listener", "");
    let _foreign = island.start("latency", "--ros-args -p role:=source -r /stamps:=/chatter");
    listener.wait_for_log(
        "/chatter: another process writes std_msgs/msg/UInt64 there; this node reads std_msgs/msg/String",
    );
    let _talker = island.start("talker", "--ros-args -p rate:=50.0");
    let (sequence, text) = parse(&listener.line());
    assert_eq!(sequence, text, "a message of the right type");
}

/// Over the network, where others keep messages for us. Five thousand of 2 kB are 10 MB.
fn memory_does_not_grow_with_what_was_heard(network: Network) {
    let island = network.island(16);
    let listener = island.start("listener", "");
    let _talker = island.start("talker", "--ros-args -p rate:=1000.0 -p padding:=2000 -p local:=network");
    heard(&listener, 500);
    let before = resident(&listener);
    heard(&listener, 5000);
    let grown = resident(&listener).saturating_sub(before);
    assert!(grown < 4_000_000, "the listener grew by {grown} bytes");
}

/// Over the network, whose threads the stop interrupts where they wait (SIGSTOP and SIGCONT, or a debugger that looks in).
fn who_was_stopped_goes_on_to_speak_and_to_hear(network: Network) {
    let island = network.island(17);
    let listener = island.start("listener", "");
    let talker = island.start("talker", "--ros-args -p rate:=50.0 -p local:=network");
    heard(&listener, 20);
    for stopped in [&talker, &listener, &talker, &listener] {
        stopped.signal("STOP");
        std::thread::sleep(Duration::from_millis(300));
        stopped.signal("CONT");
        // More than may have been on their way.
        heard(&listener, 100);
    }
}

/// Bytes of memory that a process holds.
fn resident(process: &Running) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{}/status", process.child.id())).unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
    1024 * line.trim().trim_end_matches(" kB").parse::<u64>().unwrap()
}
