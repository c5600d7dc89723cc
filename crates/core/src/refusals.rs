//! Messages that a node does not take: counted, told on /diagnostics, and logged seldom.

use crate::{Condition, Health, Interface, Level, Sink, Steady};
use std::collections::BTreeMap;
use std::fmt::Display;

/// The part of /diagnostics that tells of them.
const PART: &str = "messages";

/// Who writes nonsense, or what another one writes already, writes it many times a second: the log hears of each port now and
/// then, /diagnostics has the last reason and the count.
#[derive(Debug, Clone, Default)]
pub struct Refusals {
    count: u64,
    last: Option<Steady>,
    /// When the log heard of each port last.
    logged: BTreeMap<usize, Steady>,
    quiet: bool,
}

impl Refusals {
    /// For so long after the last one, /diagnostics warns, s.
    pub const LATELY: f64 = 5.0;
    /// Between two lines in the log about one port, s.
    pub const SELDOM: f64 = 10.0;

    /// A message on this port is not taken, for a reason given as a whole sentence.
    pub fn tell(&mut self, now: Steady, port: usize, what: String, health: &mut Health, sink: &mut dyn Sink) {
        self.count += 1;
        self.last = Some(now);
        self.quiet = false;
        if self.logged.get(&port).is_none_or(|then| now.seconds_since(*then) >= Self::SELDOM) {
            self.logged.insert(port, now);
            sink.log(Level::Warn, &what);
        }
        health.set(PART, Condition::Warn, what);
        health.value(PART, "dropped", self.count);
    }

    /// A message on this port of `interface` is not taken, for a reason that is named behind its topic.
    pub fn tell_dropped(
        &mut self,
        now: Steady,
        (interface, port): (&Interface, usize),
        why: impl Display,
        health: &mut Health,
        sink: &mut dyn Sink,
    ) {
        let topic = interface.subscriptions.get(port).map_or("?", |subscribe| subscribe.topic.as_str());
        self.tell(now, port, format!("a message on {topic} was dropped: {why}"), health, sink);
    }

    /// Ends the warning when none came for a while. To be called now and then.
    pub fn settle(&mut self, now: Steady, health: &mut Health) {
        if !self.quiet && self.last.is_none_or(|last| now.seconds_since(last) > Self::LATELY) {
            self.quiet = true;
            health.set(PART, Condition::Ok, "none was dropped lately");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Refusals;
    use crate::{Action, Condition, Health, Outbox, Steady};

    /// Ten a second on one port and one on another: each is told of at once, the first again after ten seconds.
    #[test]
    fn the_log_hears_seldom_and_the_warning_ends() {
        let (mut refusals, mut health, mut outbox) = (Refusals::default(), Health::new("/node"), Outbox::default());
        let at = |tenths: u64| Steady(tenths * 100_000_000);
        refusals.settle(at(0), &mut health);
        assert_eq!(health.worst(), Condition::Ok);
        for tenths in 0..=100 {
            refusals.tell(at(tenths), 3, format!("wrong {tenths}"), &mut health, &mut outbox);
            if tenths == 40 {
                refusals.tell(at(tenths), 4, "no number".to_owned(), &mut health, &mut outbox);
            }
            refusals.settle(at(tenths), &mut health);
            assert_eq!(health.worst(), Condition::Warn);
        }
        let lines = outbox.actions.iter().filter_map(|action| match action {
            Action::Log { text, .. } => Some(text.as_str()),
            _ => None,
        });
        assert_eq!(lines.collect::<Vec<_>>(), ["wrong 0", "no number", "wrong 100"]);
        refusals.settle(at(150), &mut health);
        assert_eq!(health.worst(), Condition::Warn);
        refusals.settle(at(151), &mut health);
        assert_eq!(health.worst(), Condition::Ok);
    }
}
