//! The command links, as the bridge tells of them.

use super::Spread;
use serde::Serialize;
use std::collections::BTreeMap;
use trench_core::RosTime;
use trench_msgs::Message;
use trench_msgs::msg::LinkStatus;

/// The link to one robot.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LinkSummary {
    /// The robot.
    pub robot: String,
    /// How many reports there are.
    pub reports: usize,
    /// Share of the reports that say it is up, 0 to 1.
    pub up: f64,
    /// The longest time from the first report that says it is down to the next that says it is up, s.
    pub longest_down: f64,
    /// Share of command frames that the robot missed: mean and largest over a second, 0 to 1.
    pub loss: f64,
    /// The largest.
    pub worst_loss: f64,
    /// Command to acknowledgement, s.
    pub round_trip: Option<Spread>,
    /// The most hops that a frame took.
    pub hops: u8,
    /// All faults that the robot told, `FAULT_*` of LinkStatus.
    pub faults: u8,
    /// Frames that were no good.
    pub rejected: u64,
}

/// Gathers reports in log order.
#[derive(Default)]
pub(super) struct Links {
    robots: BTreeMap<String, Vec<(f64, LinkStatus)>>,
}

impl Links {
    pub(super) fn take(&mut self, cdr: &[u8], t0: i64) {
        let Ok(status) = LinkStatus::decode(cdr) else { return };
        let time = RosTime::from(&status.header.stamp).seconds_since(RosTime(t0));
        self.robots.entry(status.robot.clone()).or_default().push((time, status));
    }

    pub(super) fn finish(self) -> Vec<LinkSummary> {
        self.robots.into_iter().map(|(robot, reports)| summary(robot, &reports)).collect()
    }
}

fn summary(robot: String, reports: &[(f64, LinkStatus)]) -> LinkSummary {
    let all = || reports.iter().map(|(_, status)| status);
    let losses: Vec<f64> = all().map(|status| status.loss).filter(|loss| loss.is_finite()).collect();
    let rejected = |status: Option<&(f64, LinkStatus)>| status.map_or(0, |(_, status)| status.frames_rejected);
    LinkSummary {
        robot,
        reports: reports.len(),
        up: all().filter(|status| status.up).count() as f64 / reports.len() as f64,
        longest_down: longest_down(reports),
        loss: losses.iter().sum::<f64>() / losses.len().max(1) as f64,
        worst_loss: losses.iter().copied().fold(0.0, f64::max),
        round_trip: Spread::of(all().map(|status| status.round_trip).filter(|time| *time > 0.0).collect()),
        hops: all().map(|status| status.hops).max().unwrap_or(0),
        faults: all().fold(0, |faults, status| faults | status.fault),
        rejected: rejected(reports.last()).saturating_sub(rejected(reports.first())),
    }
}

fn longest_down(reports: &[(f64, LinkStatus)]) -> f64 {
    let (mut longest, mut since) = (0.0, None);
    for (time, status) in reports {
        let from = *since.get_or_insert(*time);
        longest = f64::max(longest, time - from);
        if status.up {
            since = None;
        }
    }
    longest
}
