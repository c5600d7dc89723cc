//! Several nodes in one process: each with its own topics, services, parameters and counts, and each topic read once.

#[cfg(test)]
mod common;

use common::{Island, PATIENCE, Running};
use std::collections::BTreeMap;
use std::time::Instant;

/// Reads lines of the listeners of one process until each of their `nodes` has printed `count` messages of one talker.
#[expect(clippy::unwrap_used, reason = "a test helper")]
fn heard(listeners: &Running, nodes: usize, count: usize) -> BTreeMap<u64, usize> {
    let mut times: BTreeMap<u64, usize> = BTreeMap::new();
    let mut unheard = None;
    let start = Instant::now();
    while times.values().filter(|heard| **heard == nodes).count() < count {
        assert!(start.elapsed() < PATIENCE, "{times:?}");
        let line = listeners.line();
        let (sequence, text) = line.split_once(' ').unwrap();
        let (sequence, text) = (sequence.parse::<u64>().unwrap(), text.trim().parse::<u64>().unwrap());
        // To the network alone messages are not sent, nor counted, before somebody reads them.
        assert_eq!(text - sequence, *unheard.get_or_insert(text - sequence));
        *times.entry(text).or_default() += 1;
    }
    times
}

#[test]
fn every_node_gets_every_message_once() {
    for (number, local) in ["network", "shared_memory"].into_iter().enumerate() {
        let island = Island::new(30 + number as u16);
        let listeners = island.start("listener", "--namespaces [a,b,c]");
        let talker = island.start("talker", &format!("--ros-args -p rate:=200.0 -p local:={local}"));
        let times = heard(&listeners, 3, 400);
        drop(talker);
        let more_than_once = times.values().any(|heard| *heard > 3);
        let first = times.keys().next().copied().unwrap_or_default();
        let missing = (first..first + 400).filter(|number| times.get(number) != Some(&3)).count();
        assert!(!more_than_once && missing == 0, "over {local}: {times:?}");
    }
}

#[test]
fn late_nodes_get_what_is_latched() {
    let island = Island::new(32);
    let talker = island.start("talker", "--ros-args -p rate:=0.3 -p latched:=true --log-level debug");
    talker.wait_for_log("said 2");
    let listeners = island.start("listener", "--namespaces [a,b] --ros-args -p latched:=true");
    let last: Vec<String> = (0..2).map(|_| listeners.line()).collect();
    assert_eq!(last[0], last[1], "both get the same last message");
}

#[test]
fn nodes_of_one_process_write_and_serve_each_for_itself() {
    let island = Island::new(33);
    let listener = island.start("listener", "");
    let talkers = island.start("talker", "--namespaces [a,/lab/b] --ros-args -p rate:=40.0 --log-level debug");
    let mut times: BTreeMap<String, usize> = BTreeMap::new();
    while !times.values().any(|heard| *heard == 2) {
        *times.entry(listener.line()).or_default() += 1;
    }
    talkers.signal("INT");
    let (code, _, said) = talkers.end();
    assert_eq!(code, 0, "{said:?}");
    assert!(said.iter().any(|line| line.contains("[a.talker]")), "{said:?}");
    assert!(said.iter().any(|line| line.contains("[lab.b.talker]")), "{said:?}");
}

#[test]
fn one_wrong_node_stops_the_process_before_it_works() {
    let island = Island::new(34);
    let (code, _, said) = island.start("talker", "--namespaces [a,b] --ros-args -p talker:rate:=-1.0").end();
    assert_eq!(code, 3, "{said:?}");
    let (code, _, said) = island.start("talker", "--namespaces [a,a]").end();
    assert_eq!(code, 2, "{said:?}");
    assert!(said.iter().any(|line| line.contains("--namespaces [a,a]` names no namespaces")), "{said:?}");
}
