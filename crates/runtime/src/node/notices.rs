//! What the runtime itself notices, and says on /diagnostics in the node's name: a wall clock that is set, packets that are none,
//! routers that are gone, writers of which a reader gets nothing.

use super::Node;
use crate::clock::{steady_now, wall_now};
use crate::transport::malformed_packets;
use std::collections::BTreeMap;
use trench_core::{Condition, Level, RosTime, Sink, Steady, Times, jump_between};
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
    /// Since when routers are gone, by where they listened.
    gone: BTreeMap<String, Steady>,
    /// What is to be said of routers that are there again, once those who listen are told of it too, and when.
    back: Option<(Steady, String)>,
}

/// How soon after a router came back that it was gone is said again, s: nothing said meanwhile went further than this host.
const BACK: f64 = 0.5;

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
        if let Some((_, text)) = self.back.take_if(|(at, _)| *at <= now) {
            news.push(("network", Condition::Warn, text));
        }
        self.told.extend(news.iter().map(|(part, ..)| (*part, now)));
        if !self.gone.is_empty() {
            // It stands until the router is there again.
            self.told.remove("network");
        }
        let over = self.told.extract_if(.., |_, told| now.seconds_since(*told) > LATELY);
        news.extend(over.map(|(part, _)| (part, Condition::Ok, "nothing unusual lately".to_owned())));
        news
    }

    /// Takes that a router is gone or there again; gives what is to be said of it.
    fn router(&mut self, now: Steady, at: &str, is_there: bool) -> (Condition, String) {
        if !is_there {
            self.gone.entry(at.to_owned()).or_insert(now);
            return (Condition::Error, format!("the router at {at} is gone: nothing comes from other hosts"));
        }
        let seconds = self.gone.remove(at).map_or(0.0, |since| now.seconds_since(since));
        let text = format!("the router at {at} was gone for {seconds:.1} s");
        self.back = Some((now.plus_seconds(BACK), text.clone()));
        (Condition::Warn, text)
    }
}

impl Node {
    /// Says what the runtime has noticed, where the node writes /diagnostics.
    pub(super) fn tell_notices(&mut self, now: Steady) {
        let news = self.notices.look(now, wall_now(), malformed_packets());
        self.tell(news);
    }

    /// Says on its standard error and on /diagnostics that the connection to a router is gone, or there again. The one always comes; the
    /// other where some connection is left, and once it is there again.
    pub(super) fn router_changed(&mut self, at: &str, is_there: bool) {
        let (condition, text) = self.notices.router(steady_now(), at, is_there);
        let level = if is_there { Level::Warn } else { Level::Error };
        self.ports.log(level, &format!("network: {text}"));
        self.tell(vec![("network", condition, text)]);
    }

    /// Says on its standard error and on /diagnostics that somebody writes a topic of which this node gets nothing.
    pub(crate) fn topic_unread(&mut self, text: String) {
        self.ports.warn(&text);
        self.notices.told.insert("topics", steady_now());
        self.tell(vec![("topics", Condition::Warn, text)]);
    }

    fn tell(&mut self, news: Vec<Notice>) {
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

    #[test]
    fn a_router_that_is_gone_is_told_until_it_is_there_again_and_then_for_how_long() {
        let at = |ms: u64| Steady(ms * 1_000_000);
        let mut notices = Notices::default();
        let look = |notices: &mut Notices, ms: u64| -> Vec<String> {
            let news = notices.look(at(ms), RosTime(ms as i64 * 1_000_000), 0);
            news.into_iter().map(|(part, condition, text)| format!("{part}: {} {text}", condition as u8)).collect()
        };
        assert!(look(&mut notices, 0).is_empty());
        let (condition, text) = notices.router(at(100), "tcp/gate:7447", false);
        assert_eq!(
            (condition as u8, text.as_str()),
            (2, "the router at tcp/gate:7447 is gone: nothing comes from other hosts")
        );
        for ms in (200..20_000).step_by(100) {
            assert!(look(&mut notices, ms).is_empty(), "it stands");
        }
        let (condition, text) = notices.router(at(20_000), "tcp/gate:7447", true);
        assert_eq!((condition as u8, text.as_str()), (1, "the router at tcp/gate:7447 was gone for 19.9 s"));
        assert!(look(&mut notices, 20_400).is_empty());
        assert_eq!(look(&mut notices, 20_500), ["network: 1 the router at tcp/gate:7447 was gone for 19.9 s"]);
        assert!(look(&mut notices, 25_500).is_empty());
        assert_eq!(look(&mut notices, 25_600), ["network: 0 nothing unusual lately"]);
    }
}
