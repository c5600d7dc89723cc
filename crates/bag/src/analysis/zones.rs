//! When two robots were nearer to each other than zoning allows.

use crate::run::{Run, distance};
use serde::Serialize;

/// Two robots in each other's zone 1.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ZoneVisit {
    /// Their names.
    pub robots: [String; 2],
    /// From when, s.
    pub from: f64,
    /// Until when, s.
    pub to: f64,
    /// The smallest distance of their centres meanwhile, m.
    pub distance: f64,
}

/// All visits after the beginning, by pair and time. Both ends are times of poses.
pub(super) fn visits(run: &Run, radius: f64) -> Vec<ZoneVisit> {
    let times = run.times(0.0, run.span().map_or(0.0, |(_, last)| last));
    let robots: Vec<_> = run.robots.iter().collect();
    let mut visits = Vec::new();
    for (index, (a, first)) in robots.iter().enumerate() {
        for (b, second) in robots.iter().skip(index + 1) {
            let mut current: Option<ZoneVisit> = None;
            for &time in &times {
                let Some((one, other)) = first.pose_at(time).zip(second.pose_at(time)) else { continue };
                let apart = distance(one.position(), other.position());
                if apart >= radius {
                    visits.extend(current.take());
                    continue;
                }
                let names = || [(*a).clone(), (*b).clone()];
                let new = || ZoneVisit { robots: names(), from: time, to: time, distance: apart };
                let visit = current.get_or_insert_with(new);
                visit.to = time;
                visit.distance = visit.distance.min(apart);
            }
            visits.extend(current);
        }
    }
    visits
}
