//! What the runtime itself notices, and says on /diagnostics in the node's name: a wall clock that is set, packets that are none.

use super::Node;
use crate::clock::wall_now;
use crate::transport::malformed_packets;
use std::collections::BTreeMap;
use trench_core::{Condition, RosTime, Sink, Steady, Times, jump_between};
use trench_msgs::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};
use trench_msgs::std_msgs::Header;

/// How long what was noticed stands, s.
const LATELY: f64 = 5.0;
/// Between two words about packets, s.
const AGAIN: f64 = 1.0;

/// A condition of a part.
type Notice = (&'static str, Condition, String);

/// What was noticed so far.
#[derive(Debug, Clone, Default)]
pub(super) struct Notices {
    /// Wall clock (in the place of ROS time) and monotonic clock at the last look.
    clocks: Option<Times>,
    malformed: u64,
    told: BTreeMap<&'static str, Steady>,
}

impl Notices {
    /// Looks at the wall clock and at how many packets were none; gives what is to be said.
    fn look(&mut self, now: Steady, wall: RosTime, malformed: u64) -> Vec<Notice> {
        let mut news: Vec<Notice> = Vec::new();
        let clocks = Times { ros: wall, steady: now };
        if let Some(jump) = self.clocks.replace(clocks).and_then(|last| jump_between(last, clocks)) {
            news.push(("wall clock", Condition::Warn, format!("was set by {:+.1} s", jump as f64 * 1e-9)));
        }
        let is_time = self.told.get("network").is_none_or(|told| now.seconds_since(*told) >= AGAIN);
        if malformed > self.malformed && is_time {
            let count = malformed - std::mem::replace(&mut self.malformed, malformed);
            news.push(("network", Condition::Warn, format!("{count} packets came that are no DDS messages")));
        }
        self.told.extend(news.iter().map(|(part, ..)| (*part, now)));
        let over = self.told.extract_if(.., |_, told| now.seconds_since(*told) > LATELY);
        news.extend(over.map(|(part, _)| (part, Condition::Ok, "nothing unusual lately".to_owned())));
        news
    }
}

impl Node {
    /// Says what the runtime has noticed, where the node writes /diagnostics.
    pub(super) fn tell_notices(&mut self, now: Steady) {
        let news = self.notices.look(now, wall_now(), malformed_packets());
        if news.is_empty() {
            return;
        }
        let Some(port) = self.ports.publications.iter().position(|port| port.topic() == "/diagnostics") else { return };
        let name = &self.full_name;
        let status = |(part, condition, message): Notice| DiagnosticStatus {
            level: condition as u8,
            name: format!("{name}: {part}"),
            message,
            hardware_id: name.clone(),
            values: Vec::new(),
        };
        let header = Header { stamp: self.ports.clock.now().ros.into(), ..Header::default() };
        let message = DiagnosticArray { header, status: news.into_iter().map(status).collect() };
        self.ports.publish(port, &message);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_that_are_set_and_packets_that_are_none_are_told_soon_and_once() {
        let mut notices = Notices::default();
        let mut look = |ms: u64, wall_ms: i64, malformed| -> Vec<String> {
            let news = notices.look(Steady(ms * 1_000_000), RosTime(wall_ms * 1_000_000), malformed);
            news.into_iter().map(|(part, condition, text)| format!("{part}: {} {text}", condition as u8)).collect()
        };
        assert!(look(0, 500_000, 0).is_empty(), "as it begins");
        assert!(look(100, 500_110, 0).is_empty(), "drift");
        assert!(look(15_000, 515_010, 0).is_empty(), "a pause");
        assert_eq!(look(15_100, 4_115_110, 0), ["wall clock: 1 was set by +3600.0 s"]);
        assert!(look(15_200, 4_115_210, 0).is_empty());
        assert_eq!(look(15_300, 4_115_310, 3), ["network: 1 3 packets came that are no DDS messages"]);
        assert!(look(15_400, 4_115_410, 9).is_empty(), "not all the time");
        assert_eq!(look(16_400, 4_116_410, 9), ["network: 1 6 packets came that are no DDS messages"]);
        assert_eq!(look(20_200, 4_120_210, 9), ["wall clock: 0 nothing unusual lately"]);
        assert_eq!(look(21_500, 4_121_510, 9), ["network: 0 nothing unusual lately"]);
        assert_eq!(look(21_600, 521_610, 9), ["wall clock: 1 was set by -3600.0 s"]);
    }
}
