//! How many messages a topic had, how evenly they came, and how old they were.

use super::Spread;
use crate::Topic;
use serde::Serialize;
use trench_core::RosTime;

/// The messages of one topic.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TopicTraffic {
    /// Its name.
    pub topic: String,
    /// How many messages.
    pub count: u64,
    /// Between its first and its last message, Hz; nothing with fewer than two.
    pub rate: Option<f64>,
    /// The longest time without a message between two.
    pub longest_gap: Option<Gap>,
    /// From a message's stamp to its receipt at the recorder, s; nothing for topics without stamps.
    pub age: Option<Spread>,
}

/// A time without messages.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Gap {
    /// When it began, s.
    pub from: f64,
    /// s.
    pub length: f64,
}

/// Counts as messages come, in log order.
pub(super) struct Traffic {
    topics: Vec<Counted>,
}

#[derive(Default, Clone)]
struct Counted {
    count: u64,
    /// Log times of the first and the last message, ns.
    span: Option<(u64, u64)>,
    /// Where the longest gap began and ended, ns.
    gap: Option<(u64, u64)>,
    ages: Vec<f64>,
}

impl Traffic {
    pub(super) fn new(topics: usize) -> Self {
        Self { topics: vec![Counted::default(); topics] }
    }

    pub(super) fn note(&mut self, topic: usize, log_time: u64, stamp: Option<i64>) {
        let Some(counted) = self.topics.get_mut(topic) else { return };
        counted.count += 1;
        if let Some((_, last)) = counted.span
            && counted.gap.is_none_or(|(from, to)| log_time - last > to - from)
        {
            counted.gap = Some((last, log_time));
        }
        counted.span = Some((counted.span.map_or(log_time, |(first, _)| first), log_time));
        counted.ages.extend(stamp.map(|stamp| (log_time as f64 - stamp as f64) * 1e-9));
    }

    pub(super) fn finish(self, topics: &[Topic], t0: i64) -> Vec<TopicTraffic> {
        let mut traffic: Vec<_> =
            topics.iter().zip(self.topics).map(|(topic, counted)| counted.finish(&topic.name, t0)).collect();
        traffic.sort_by(|a, b| a.topic.cmp(&b.topic));
        traffic
    }
}

impl Counted {
    fn finish(self, topic: &str, t0: i64) -> TopicTraffic {
        let seconds = |from: u64, to: u64| (to - from) as f64 * 1e-9;
        let rate = self.span.map(|(first, last)| (self.count - 1) as f64 / seconds(first, last));
        let longest_gap = self.gap.map(|(from, to)| Gap { from: since(from, t0), length: seconds(from, to) });
        let rate = rate.filter(|rate| rate.is_finite());
        TopicTraffic { topic: topic.to_owned(), count: self.count, rate, longest_gap, age: Spread::of(self.ages) }
    }
}

/// A log time, s since `t0`.
fn since(log_time: u64, t0: i64) -> f64 {
    RosTime(i64::try_from(log_time).unwrap_or(i64::MAX)).seconds_since(RosTime(t0))
}

/// Whether messages of a type begin with a header: its definition says so. Constants are no part of messages.
pub(super) fn is_stamped(definition: &str) -> bool {
    let code = |line: &str| line.split('#').next().unwrap_or_default().trim().to_owned();
    let is_constant = |line: &str| {
        let mut words = line.split_whitespace().skip(1);
        words.next().is_some_and(|name| name.contains('=')) || words.next().is_some_and(|next| next.starts_with('='))
    };
    let mut fields = definition.lines().map(code).filter(|line| !line.is_empty() && !is_constant(line));
    let first = fields.next().unwrap_or_default();
    let mut words = first.split_whitespace();
    matches!(words.next(), Some("std_msgs/Header" | "std_msgs/msg/Header" | "Header")) && words.next().is_some()
}

/// The stamp of a message that begins with a header, ns; nothing for the zero that stands for none.
pub(super) fn stamp(cdr: &[u8]) -> Option<i64> {
    let is_little = cdr.get(1)? & 1 == 1;
    let (seconds, fraction) = (*cdr.get(4..)?.first_chunk()?, *cdr.get(8..)?.first_chunk()?);
    let (seconds, fraction) = match is_little {
        true => (i32::from_le_bytes(seconds), u32::from_le_bytes(fraction)),
        false => (i32::from_be_bytes(seconds), u32::from_be_bytes(fraction)),
    };
    let stamp = i64::from(seconds) * 1_000_000_000 + i64::from(fraction);
    (stamp != 0).then_some(stamp)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_are_known_by_the_definition() {
        let check = |definition: &str, expected: bool| assert_eq!(is_stamped(definition), expected, "{definition}");
        check("std_msgs/Header header\nfloat64 x\n", true);
        check("# What it is.\n\nstd_msgs/Header header   # stamp\n", true);
        check("float64 x\nstd_msgs/Header header\n", false);
        check("uint8 A=1\nuint8 B = 2\n\nstd_msgs/Header header\n", true);
        check("uint8 A=1\nuint8 b\nstd_msgs/Header header\n", false);
        check("", false);
    }

    #[test]
    fn stamps_are_read_in_either_byte_order() {
        assert_eq!(stamp(&[0, 1, 0, 0, 2, 0, 0, 0, 5, 0, 0, 0, 1]), Some(2_000_000_005));
        assert_eq!(stamp(&[0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 5]), Some(2_000_000_005));
        assert_eq!(stamp(&[0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]), None);
        assert_eq!(stamp(&[0, 1, 0, 0, 2, 0]), None);
    }
}
