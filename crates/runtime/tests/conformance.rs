//! What every transport must do, tried on real processes: order, exactly once, latched messages, large messages,
//! restarts and sudden deaths of either side. And services between processes.

#[cfg(test)]
mod common;

use common::{Island, Running};

/// The ways from a writer to a reader of the same host, by the talker's parameter `local`.
const TRANSPORTS: [&str; 3] = ["network", "shared_memory", "shared_memory_only"];

/// A test's island for each transport.
fn on_every_transport(test: u16, check: impl Fn(&Island, &str)) {
    for (number, transport) in TRANSPORTS.iter().enumerate() {
        println!("over {transport}");
        check(&Island::new(test * 3 + number as u16), transport);
    }
}

/// Sequence numbers and texts of the listener's next lines.
fn heard(listener: &Running, count: usize) -> Vec<(u64, u64)> {
    (0..count).map(|_| parse(&listener.line())).collect()
}

#[expect(clippy::unwrap_used, reason = "a test helper")]
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

#[test]
fn order_and_exactly_once_at_speed() {
    on_every_transport(0, |island, transport| {
        let listener = island.start("listener", "");
        let talker = island.start("talker", &format!("--ros-args -p rate:=2000.0 -p local:={transport}"));
        let heard = heard(&listener, 4000);
        drop(talker);
        assert_complete(&heard);
    });
}

#[test]
fn a_late_joiner_gets_the_last_latched_message_first() {
    on_every_transport(1, |island, transport| {
        let talker = island.start(
            "talker",
            &format!("--ros-args -p rate:=0.3 -p latched:=true -p local:={transport} --log-level debug"),
        );
        talker.wait_for_log("said 2");
        let listener = island.start("listener", "--ros-args -p latched:=true");
        let heard = heard(&listener, 2);
        assert!(heard[0].1 >= 2, "{heard:?}");
        assert_complete(&heard);
    });
}

#[test]
fn large_messages_arrive_whole() {
    for (number, (transport, padding)) in
        [("network", 200_000), ("shared_memory", 200_000), ("shared_memory_only", 1_327_104)].into_iter().enumerate()
    {
        let island = Island::new(6 + number as u16);
        let listener = island.start("listener", "");
        let arguments = format!("--ros-args -p rate:=10.0 -p padding:={padding} -p local:={transport}");
        let _talker = island.start("talker", &arguments);
        assert_complete(&heard(&listener, 10));
    }
}

#[test]
fn a_writer_that_dies_is_followed_by_the_next() {
    on_every_transport(3, |island, transport| {
        let listener = island.start("listener", "");
        for _life in 0..3 {
            let talker = island.start("talker", &format!("--ros-args -p rate:=500.0 -p local:={transport}"));
            // What the last life left behind it comes first; then one that counts anew.
            let first = loop {
                let (sequence, text) = parse(&listener.line());
                // To the network alone messages are not sent, nor counted, before somebody reads them.
                assert!(if transport == "network" { sequence <= text } else { sequence == text }, "{sequence} {text}");
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

#[test]
fn a_reader_that_restarts_goes_on_without_copies_or_gaps() {
    on_every_transport(4, |island, transport| {
        let _talker = island.start("talker", &format!("--ros-args -p rate:=500.0 -p local:={transport}"));
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

#[test]
fn messages_that_do_not_wake_come_with_the_next_event() {
    for (number, transport) in TRANSPORTS.iter().enumerate() {
        let island = Island::new(26 + number as u16);
        let listener = island.start("listener", "--ros-args -p wakes:=false -p period:=0.5");
        let _talker = island.start("talker", &format!("--ros-args -p rate:=200.0 -p local:={transport}"));
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
        assert!(batches[3] - batches[2] > 20, "{batches:?} over {transport}");
    }
}

#[test]
fn a_call_made_before_the_server_lives_is_answered() {
    let island = Island::new(37);
    let caller = island.start("caller", "");
    let _talker = island.start("talker", "");
    assert_eq!(caller.line(), "counting from 1");
    assert_eq!(caller.end().0, 0);
}

#[test]
fn a_call_without_a_server_fails_in_time() {
    let (code, lines, _) = Island::new(38).start("caller", "").end();
    assert_eq!((code, lines), (10, vec![]));
}
