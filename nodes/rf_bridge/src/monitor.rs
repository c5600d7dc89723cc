//! How good the link to one robot is.

use std::collections::VecDeque;
use trench_core::{RosTime, Steady, Times};
use trench_msgs::msg::LinkStatus;
use trench_msgs::std_msgs::Header;
use trench_radio::{Freshness, Stale, Telemetry};

/// Loss is taken over this time, s.
const WINDOW: f64 = 1.0;

/// Weight of a new round trip in the filtered one.
const SMOOTHING: f64 = 0.2;

/// The link to one robot.
#[derive(Debug, Clone, Default)]
pub(crate) struct Monitor {
    freshness: Freshness,
    heard: Option<Heard>,
    /// When, packets missed, last counter obeyed: both wrap.
    window: VecDeque<(Steady, u16, u16)>,
    round_trip: f64,
    received: u64,
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
    pub(crate) fn accept(&mut self, counter: u64, now: Steady, authenticated: bool) -> Result<u64, Stale> {
        let result = self.freshness.accept(counter, now.0, authenticated);
        self.rejected += u64::from(result.is_err());
        result
    }

    /// Takes a report that was accepted. `sent_at`: when the packet that it names as its last was sent, if known.
    pub(crate) fn update(&mut self, at: Times, report: Telemetry, relayed: u8, sent_at: Option<Steady>) {
        self.received += 1;
        self.heard = Some(Heard { at: at.steady, ros: at.ros, report, relayed });
        self.window.push_back((at.steady, report.missed, report.last_counter));
        while self.window.front().is_some_and(|(then, ..)| at.steady.seconds_since(*then) > WINDOW) {
            self.window.pop_front();
        }
        if let Some(sent_at) = sent_at.filter(|_| report.last_age_ms < u8::MAX) {
            let round_trip = at.steady.seconds_since(sent_at) - 1e-3 * f64::from(report.last_age_ms);
            let weight = if self.round_trip == 0.0 { 1.0 } else { SMOOTHING };
            self.round_trip += weight * (round_trip.max(0.0) - self.round_trip);
        }
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
        let (Some(first), Some(last)) = (self.window.front(), self.window.back()) else { return 0.0 };
        let (missed, counted) = (last.1.wrapping_sub(first.1), last.2.wrapping_sub(first.2));
        if counted == 0 { 0.0 } else { (f64::from(missed) / f64::from(counted)).min(1.0) }
    }

    /// The message.
    pub(crate) fn status(&self, at: Times, robot: &str, silence: f64) -> LinkStatus {
        let heard = self.heard.as_ref();
        LinkStatus {
            header: Header { stamp: at.ros.into(), frame_id: String::new() },
            robot: robot.to_owned(),
            up: self.up(at.steady, silence),
            loss: self.loss(),
            signal: heard.map_or(0.0, |heard| f64::from(heard.report.signal_dbm)),
            round_trip: self.round_trip,
            hops: heard.map_or(0, |heard| heard.relayed + 1),
            fault: heard.map_or(0, |heard| heard.report.fault.0),
            last_heard: heard.map(|heard| heard.ros.into()).unwrap_or_default(),
            commands_sent: self.sent,
            telemetry_received: self.received,
            frames_rejected: self.rejected,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loss_over_a_second_and_round_trip() {
        let mut monitor = Monitor::default();
        for tenth in 0..32_u64 {
            // Ten packets a tenth of a second, of which one is missed in the first two seconds; both counters wrap.
            let missed = 65_530_u16.wrapping_add(tenth.min(20) as u16);
            let last_counter = 65_500_u16.wrapping_add(10 * tenth as u16);
            let report = Telemetry { missed, last_counter, last_age_ms: 7, ..Telemetry::default() };
            let at = Times { steady: Steady(tenth * 100_000_000), ros: RosTime(0) };
            monitor.update(at, report, 0, Some(Steady(at.steady.0.saturating_sub(20_000_000))));
            let loss = monitor.status(at, "r", 0.5).loss;
            assert!((loss - if tenth == 0 { 0.0 } else { 0.1 }).abs() < 1e-9 || tenth > 20, "{tenth}: {loss}");
        }
        let at = Times { steady: Steady(3_100_000_000), ros: RosTime(0) };
        let status = monitor.status(at, "r", 0.5);
        assert!(status.up && status.loss == 0.0 && (status.round_trip - 0.013).abs() < 1e-6, "{status:?}");
        let later = Times { steady: Steady(3_700_000_000), ros: RosTime(0) };
        assert!(!monitor.status(later, "r", 0.5).up);
    }
}
