use super::*;
use crate::clock::steady_now;
use rustdds::mio1::{Events, Poll, Token};
use std::ops::Range;
use std::time::Duration;
use trench_core::{Qos, Source};

const TYPE: &str = "test_msgs/msg/Bytes";

struct Pair {
    host: Host,
    topic: SharedTopic,
    poll: Poll,
    prefix: String,
}

impl Drop for Pair {
    /// The node's management file has no next node of this prefix to use it.
    fn drop(&mut self) {
        forget_shared_memory(&self.prefix).unwrap();
    }
}

impl Pair {
    fn new(test: &str) -> Self {
        let prefix = format!("{test}{}", std::process::id());
        let host = Host::join_apart(7, &prefix).unwrap();
        let topic = host.topic("/bytes", TYPE);
        Self { host, topic, poll: Poll::new().unwrap(), prefix }
    }

    fn writer(&self, max_len: usize, qos: Qos) -> SharedWriter {
        self.host.writer(&self.topic, max_len, qos).unwrap()
    }

    fn reader(&self, qos: Qos) -> Option<SharedReader> {
        self.host.reader(&self.topic, qos, [4; 16], self.poll.registry(), Some(Token(3))).unwrap()
    }
}

fn send(writer: &mut SharedWriter, sequence: u64, message: &[u8]) {
    let source = Source { gid: [9; 16], sequence };
    let mut fill = |out: &mut [u8]| {
        out[..message.len()].copy_from_slice(message);
        message.len()
    };
    let mut copied = Vec::new();
    let all_woken = writer.publish_with(source, message.len() + 5, &mut fill, |copy| copied = copy.to_vec()).unwrap();
    assert!(all_woken);
    assert_eq!(copied, message);
}

fn take_all(reader: &SharedReader) -> Vec<(u64, Vec<u8>)> {
    let samples = std::iter::from_fn(|| reader.take());
    samples.map(Result::unwrap).map(|sample| (sample.source().sequence, sample.cdr().to_vec())).collect()
}

#[test]
fn messages_arrive_in_order_with_their_source_and_wake_the_loop() {
    let mut pair = Pair::new("order");
    assert!(pair.reader(Qos::RELIABLE).is_none(), "nobody writes yet");
    let mut writer = pair.writer(64, Qos::RELIABLE);
    let reader = pair.reader(Qos::RELIABLE).unwrap();
    for sequence in 1..=40 {
        send(&mut writer, sequence, &[sequence as u8; 3]);
    }
    let mut events = Events::with_capacity(4);
    pair.poll.poll(&mut events, Some(Duration::from_secs(5))).unwrap();
    assert_eq!(events.iter().next().unwrap().token(), Token(3));
    reader.clear_wakeup();
    let expected: Vec<_> = (1..=40).map(|sequence| (sequence, vec![sequence as u8; 3])).collect();
    assert_eq!(take_all(&reader), expected);
}

#[test]
fn a_reader_that_does_not_wait_gets_messages_with_their_times_and_nobody_is_woken_in_vain() {
    let mut pair = Pair::new("quiet");
    let mut writer = pair.writer(64, Qos::RELIABLE);
    let quiet = pair.host.reader(&pair.topic, Qos::RELIABLE, [5; 16], pair.poll.registry(), None).unwrap().unwrap();
    let before = steady_now();
    send(&mut writer, 1, b"quiet");
    let mut events = Events::with_capacity(4);
    pair.poll.poll(&mut events, Some(Duration::ZERO)).unwrap();
    assert!(events.is_empty());
    let sample = quiet.take().unwrap().unwrap();
    assert_eq!(sample.cdr(), b"quiet");
    assert!((before..=steady_now()).contains(&sample.written()));
    assert_eq!(writer.gids(), [[5; 16]].into());
}

#[test]
fn late_joiners_get_the_latched_message_and_others_do_not() {
    let pair = Pair::new("late");
    let mut writer = pair.writer(64, Qos::LATCHED);
    send(&mut writer, 1, b"old");
    send(&mut writer, 2, b"latched");
    let (latched, volatile) = (pair.reader(Qos::LATCHED).unwrap(), pair.reader(Qos::RELIABLE).unwrap());
    send(&mut writer, 3, b"new");
    assert_eq!(take_all(&latched), [(2, b"latched".to_vec()), (3, b"new".to_vec())]);
    assert_eq!(take_all(&volatile), [(3, b"new".to_vec())]);
}

#[test]
fn a_message_longer_than_announced_still_arrives() {
    let pair = Pair::new("long");
    let mut writer = pair.writer(16, Qos::RELIABLE);
    let reader = pair.reader(Qos::RELIABLE).unwrap();
    let long = vec![7; 300_000];
    // Nothing is lost that waits for a reader.
    send(&mut writer, 1, b"short");
    send(&mut writer, 2, &long);
    send(&mut writer, 3, b"short again");
    assert_eq!(take_all(&reader), [(1, b"short".to_vec()), (2, long), (3, b"short again".to_vec())]);
}

#[test]
fn a_message_is_read_where_it_lies_in_shared_memory() {
    let pair = Pair::new("place");
    let image = vec![200; 768 * 576 * 3];
    let mut writer = pair.writer(image.len() + 8, Qos::SENSOR);
    let reader = pair.reader(Qos::SENSOR).unwrap();
    let mut written_at = 0..0;
    let mut fill = |out: &mut [u8]| {
        out.copy_from_slice(&image);
        written_at = addresses(out);
        out.len()
    };
    writer.publish_with(Source::default(), image.len(), &mut fill, |_| {}).unwrap();
    let sample: SharedSample = reader.take().unwrap().unwrap();
    let read_at = addresses(sample.cdr());
    for (place, who) in [(written_at, "written"), (read_at, "read")] {
        assert!(
            shared_mappings().iter().any(|mapping| mapping.start <= place.start && place.end <= mapping.end),
            "{who}"
        );
    }
    assert_eq!(sample.cdr(), image);
}

fn addresses(bytes: &[u8]) -> Range<usize> {
    let range = bytes.as_ptr_range();
    range.start as usize..range.end as usize
}

/// Where this process sees shared memory of Trench.
fn shared_mappings() -> Vec<Range<usize>> {
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
    let ours = maps.lines().filter(|line| line.contains("/dev/shm/trench_"));
    ours.map(|line| {
        let (start, end) = line.split_whitespace().next().unwrap().split_once('-').unwrap();
        usize::from_str_radix(start, 16).unwrap()..usize::from_str_radix(end, 16).unwrap()
    })
    .collect()
}
