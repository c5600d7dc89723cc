//! How good the link to one robot is.

use crate::downlink::Sent;
use std::collections::VecDeque;
use trench_core::{RosTime, Steady, Times};
use trench_msgs::msg::LinkStatus;
use trench_msgs::std_msgs::Header;
use trench_radio::{Freshness, Stale, TELEMETRY_ROUND, Telemetry};

/// Loss is taken over this time, s.
const WINDOW: f64 = 1.0;

/// More than this share of lost packets is named, if so many were sent: of ten three are lost by chance now and then.
const POOR: f64 = 0.2;
const ENOUGH: u64 = 20;

/// A report is late, s, beyond what air, relays and the line take longer at one time than at another.
const LATE: f64 = 0.04;

/// Reports missed one after the other say that much is lost; more of them, that the robot is gone, which its link says.
const IN_A_ROW: u64 = 2;

/// That a robot was switched off and on is told for so long, s.
const NEWS: f64 = 2.0;

/// Weight of a new round trip in the filtered one.
const SMOOTHING: f64 = 0.2;

/// The link to one robot.
#[derive(Debug, Clone, Default)]
pub(crate) struct Monitor {
    freshness: Freshness,
    heard: Option<Heard>,
    /// When, packets the robot had received (wraps), packets sent before the last of them.
    window: VecDeque<(Steady, u16, u64)>,
    round_trip: f64,
    /// When, and how long a packet and the report that names it took, s.
    round_trips: VecDeque<(Steady, f64)>,
    received: u64,
    /// When it said first what only a robot says that was switched on since its last report.
    anew: Option<Steady>,
    /// Reports that were due since the last one.
    missed: u64,
    pub(crate) rejected: u64,
    pub(crate) sent: u64,
}

#[derive(Debug, Clone, Copy)]
struct Heard {
    at: Steady,
    ros: RosTime,
    report: Telemetry,
    relayed: u8,
}

impl Monitor {
    /// Whether a packet with this counter is new.
    pub(crate) fn accept(&mut self, counter: u64, now: Steady, authenticated: bool) -> Result<(), Stale> {
        let result = self.freshness.accept(counter, now.0, authenticated);
        self.rejected += u64::from(result.is_err());
        result
    }

    /// Takes a report that was accepted; gives how many packets reached the robot since the one before, and how many did
    /// not. `sent`: the packet that it names as its last, if known.
    pub(crate) fn update(&mut self, at: Times, report: Telemetry, relayed: u8, sent: Option<Sent>) -> (u64, u64) {
        self.received += 1;
        self.missed = 0;
        if self.report().is_some_and(|last| switched_on_between(last, &report)) {
            self.anew = Some(at.steady);
            self.window.clear();
            self.round_trips.clear();
        }
        self.heard = Some(Heard { at: at.steady, ros: at.ros, report, relayed });
        let before = self.window.back().copied();
        self.window.extend(sent.map(|sent| (at.steady, report.received, sent.before)));
        while self.window.front().is_some_and(|(then, ..)| at.steady.seconds_since(*then) > WINDOW) {
            self.window.pop_front();
        }
        if let Some(sent) = sent.filter(|_| report.last_age_ms < u8::MAX) {
            let round_trip = (at.steady.seconds_since(sent.at) - 1e-3 * f64::from(report.last_age_ms)).max(0.0);
            let weight = if self.round_trip == 0.0 { 1.0 } else { SMOOTHING };
            self.round_trip += weight * (round_trip - self.round_trip);
            while self.round_trips.front().is_some_and(|(then, _)| at.steady.seconds_since(*then) > WINDOW) {
                self.round_trips.pop_front();
            }
            self.round_trips.push_back((at.steady, round_trip));
        }
        // Of a robot that was silent for long nobody knows why.
        let before = before.filter(|(then, ..)| at.steady.seconds_since(*then) <= WINDOW);
        before.zip(sent).map_or((0, 0), |((_, received, sent_before), sent)| {
            let reached = u64::from(report.received.wrapping_sub(received));
            (reached, sent.before.saturating_sub(sent_before).saturating_sub(reached))
        })
    }

    /// The shortest round trip of the last second, s; none where no report has named a packet of ours. No packet took longer than its
    /// own round trip.
    pub(crate) fn least_round_trip(&self, now: Steady) -> Option<f64> {
        let lately = self.round_trips.iter().filter(|(then, _)| now.seconds_since(*then) <= WINDOW);
        lately.map(|(_, round_trip)| *round_trip).reduce(f64::min)
    }

    /// How many more reports are overdue than were when this was asked before; `since`: from when on they would have been heard.
    pub(crate) fn overdue(&mut self, now: Steady, since: Steady) -> u64 {
        let Some(heard) = &self.heard else { return 0 };
        let silent = now.seconds_since(heard.at.max(since).plus_seconds(LATE));
        let missed = ((silent / (TELEMETRY_ROUND as f64 * 1e-9)) as u64).min(IN_A_ROW);
        let more = missed.saturating_sub(self.missed);
        self.missed += more;
        more
    }

    /// Whether it was switched off and on a moment ago.
    pub(crate) fn is_anew(&self, now: Steady) -> bool {
        self.anew.is_some_and(|at| now.seconds_since(at) < NEWS)
    }

    /// The last report.
    pub(crate) fn report(&self) -> Option<&Telemetry> {
        self.heard.as_ref().map(|heard| &heard.report)
    }

    /// Whether it was heard within `silence` seconds.
    pub(crate) fn up(&self, now: Steady, silence: f64) -> bool {
        self.heard.is_some_and(|heard| now.seconds_since(heard.at) <= silence)
    }

    /// The share of packets that the robot missed lately, 0 to 1.
    fn loss(&self) -> f64 {
        let (received, sent) = self.lately();
        if sent == 0 { 0.0 } else { (1.0 - received as f64 / sent as f64).clamp(0.0, 1.0) }
    }

    /// Packets that the robot received lately, of those sent.
    fn lately(&self) -> (u64, u64) {
        let (Some(first), Some(last)) = (self.window.front(), self.window.back()) else { return (0, 0) };
        (last.1.wrapping_sub(first.1).into(), last.2.saturating_sub(first.2))
    }

    /// Whether it loses more than a link in order does by chance.
    pub(crate) fn is_poor(&self) -> bool {
        self.lately().1 >= ENOUGH && self.loss() > POOR
    }

    /// The message; `hears` are the names of the robots that it hears.
    pub(crate) fn status(&self, at: Times, robot: &str, hears: Vec<String>, silence: f64) -> LinkStatus {
        let heard = self.heard.as_ref();
        LinkStatus {
            header: Header { stamp: at.ros.into(), frame_id: String::new() },
            robot: robot.to_owned(),
            up: self.up(at.steady, silence),
            loss: self.loss(),
            signal: heard.map_or(0.0, |heard| f64::from(heard.report.signal_dbm)),
            round_trip: self.round_trip,
            hops: heard.map_or(0, |heard| heard.relayed.max(heard.report.last_relayed) + 1),
            hears,
            fault: heard.map_or(0, |heard| heard.report.fault.0),
            last_heard: heard.map(|heard| heard.ros.into()).unwrap_or_default(),
            commands_sent: self.sent,
            telemetry_received: self.received,
            frames_rejected: self.rejected,
        }
    }
}

/// Whether a robot was switched off and on between two of its reports. The time since it was switched on wraps after 49
/// days.
fn switched_on_between(last: &Telemetry, next: &Telemetry) -> bool {
    next.uptime_ms.wrapping_sub(last.uptime_ms) > u32::MAX / 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_that_does_not_come_in_its_round_is_missed_once_and_three_are_two() {
        let (mut monitor, mut missed) = (Monitor::default(), Vec::new());
        let at = |ms: u64| Times { steady: Steady(ms * 1_000_000), ros: RosTime(0) };
        assert_eq!(monitor.overdue(at(900).steady, Steady(0)), 0, "it was never heard");
        for heard in [1000, 1120, 1700] {
            monitor.update(at(heard), Telemetry::default(), 0, None);
            let until = if heard == 1000 { 1120 } else { heard + 580 };
            missed.extend((heard..until).filter(|ms| monitor.overdue(at(*ms).steady, Steady(0)) == 1));
        }
        assert_eq!(missed, [1260, 1360, 1840, 1940]);
        monitor.update(at(3000), Telemetry::default(), 0, None);
        assert_eq!(monitor.overdue(at(3500).steady, at(3450).steady), 0, "the bridge did not listen");
    }

    #[test]
    fn loss_over_a_second_and_round_trip() {
        let mut monitor = Monitor::default();
        for tenth in 0..32_u64 {
            // Ten packets a tenth of a second, of which one is missed in the first two seconds; the counter wraps.
            let missed = tenth.min(20);
            let received = 65_500_u16.wrapping_add((10 * tenth - missed) as u16);
            let report = Telemetry { received, last_age_ms: 7, ..Telemetry::default() };
            let at = Times { steady: Steady(tenth * 100_000_000), ros: RosTime(0) };
            let sent = Sent::of_test(Steady(at.steady.0.saturating_sub(20_000_000)), 10 * tenth);
            monitor.update(at, report, 0, Some(sent));
            let loss = monitor.status(at, "r", Vec::new(), 0.5).loss;
            assert!((loss - if tenth == 0 { 0.0 } else { 0.1 }).abs() < 1e-9 || tenth > 20, "{tenth}: {loss}");
        }
        let at = Times { steady: Steady(3_100_000_000), ros: RosTime(0) };
        let status = monitor.status(at, "r", Vec::new(), 0.5);
        assert!(status.up && status.loss == 0.0 && (status.round_trip - 0.013).abs() < 1e-6, "{status:?}");
        let later = Times { steady: Steady(3_700_000_000), ros: RosTime(0) };
        assert!(!monitor.status(later, "r", Vec::new(), 0.5).up);
    }
}
