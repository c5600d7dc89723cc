//! How a run went, for people and for programs.

use serde::Serialize;

/// A run, judged.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Of the scenario.
    pub name: String,
    /// Of the thesis.
    pub section: String,
    /// s.
    pub duration: f64,
    /// s.
    pub step: f64,
    /// One a case.
    pub cases: Vec<CaseSummary>,
}

/// A team.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CaseSummary {
    /// What legends call it.
    pub label: String,
    /// s after which every robot conforms for good; none if one does not.
    pub conforms_after: Option<f64>,
    /// Least distance of any two robots, m.
    pub closest_pair: Option<f64>,
    /// Least gap between a robot and each obstacle's own outline, m.
    pub obstacles: Vec<ObstacleSummary>,
    /// s after which every leader is for good in its follower's neutral zone; none where it is not.
    pub neutral_after: Option<f64>,
    /// Seconds that robots spent in zone 1 of a robot, summed over pairs.
    pub in_zone_1: f64,
    /// By rank.
    pub robots: Vec<RobotSummary>,
}

/// An obstacle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ObstacleSummary {
    /// Its id.
    pub id: u32,
    /// m.
    pub least_gap: f64,
}

/// A robot.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RobotSummary {
    /// Its name.
    pub name: String,
    /// m, at the end.
    pub position: [f64; 2],
    /// Distance from what draws it at the end, m.
    pub error: f64,
    /// s after which it stays within the tolerance.
    pub conforms_after: Option<f64>,
    /// m, at the end.
    pub leader_distance: Option<f64>,
    /// Least and greatest, m.
    pub leader_distance_range: Option<[f64; 2]>,
    /// phi at the end, rad (chapter 4).
    pub misalignment: Option<f64>,
    /// Where phi comes to rest under (3.13), rad.
    pub resting_misalignment: Option<f64>,
    /// Integral of v^2 + omega^2 (Table 4.1).
    pub effort: Option<f64>,
    /// The law's Lyapunov function (A.10, A.12, A.18, chapter 4) along the run, where it was asked.
    pub lyapunov: Option<LyapunovSummary>,
}

/// A Lyapunov function along a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LyapunovSummary {
    /// Its greatest value.
    pub greatest: f64,
    /// Its value at the end.
    pub last: f64,
    /// The greatest rate that the law gave it, 1/s: not above 0 where the stability argument holds.
    pub greatest_rate: f64,
}
