//! How a run went, looked at after every step.

use crate::closest::Closest;
use crate::{ChosenLaw, Sample, Scenario, Seat, Simulation, Task};
use serde::Serialize;
use trench_formation::Vector2;
use trench_formation::stability::final_misalignment;
use trench_formation::zoning::Zone;

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

/// What is kept between steps.
#[derive(Debug, Clone)]
pub struct Measures {
    seats: Vec<Seat>,
    last_away: Vec<f64>,
    leader_range: Vec<[f64; 2]>,
    lyapunov: Vec<Option<LyapunovSummary>>,
    /// By case.
    closest: Vec<Closest>,
    /// By case: id of each obstacle and the least gap from it, m.
    gaps: Vec<Vec<(u32, f64)>>,
    last_outside: Vec<f64>,
    in_zone_1: Vec<f64>,
    last: (f64, Vec<Sample>),
}

impl Measures {
    /// Before the first sample.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        let (seats, cases) = (scenario.seats(), scenario.cases().len());
        let count = seats.len();
        Self {
            seats,
            last_away: vec![-1.0; count],
            leader_range: vec![[f64::INFINITY, 0.0]; count],
            lyapunov: vec![None; count],
            closest: vec![Closest::default(); cases],
            gaps: vec![Vec::new(); cases],
            last_outside: vec![-1.0; cases],
            in_zone_1: vec![0.0; cases],
            last: (0.0, Vec::new()),
        }
    }

    /// Looks at a sample of all robots.
    pub fn take(&mut self, scenario: &Scenario, simulation: &Simulation, samples: &[Sample]) {
        let time = simulation.time();
        for (index, (sample, seat)) in samples.iter().zip(&self.seats).enumerate() {
            if sample.deviation.is_nan() || sample.deviation > scenario.tolerance {
                self.last_away[index] = time;
            }
            if let Some([last, rate]) = sample.lyapunov {
                let before =
                    self.lyapunov[index].unwrap_or(LyapunovSummary { greatest: last, last, greatest_rate: rate });
                let (greatest, greatest_rate) = (before.greatest.max(last), before.greatest_rate.max(rate));
                self.lyapunov[index] = Some(LyapunovSummary { greatest, last, greatest_rate });
            }
            if let Some(leader) = seat.leader {
                let distance = (samples[leader].position - sample.position).norm();
                let [least, greatest] = self.leader_range[index];
                self.leader_range[index] = [least.min(distance), greatest.max(distance)];
                if scenario.zoning().is_some_and(|zoning| zoning.zone(distance) != Zone::Neutral) {
                    self.last_outside[seat.case] = time;
                }
            }
        }
        // Robots of a case stand together.
        let mut first = 0;
        for team in self.seats.chunk_by(|seat, next| seat.case == next.case) {
            let (case, rest) = (team[0].case, first + team.len());
            let in_zone_1 = &mut self.in_zone_1[case];
            self.closest[case].take(&samples[first..rest], scenario.zoning(), || *in_zone_1 += scenario.timing.step);
            first = rest;
        }
        if let Some(real) = simulation.obstacles() {
            for gaps in &mut self.gaps {
                gaps.resize(real.len(), (0, f64::INFINITY));
            }
            for (sample, seat) in samples.iter().zip(&self.seats) {
                for (obstacle, (id, gap)) in real.iter().zip(&mut self.gaps[seat.case]) {
                    *id = obstacle.id;
                    *gap = gap.min(obstacle.shape.outline().approach(sample.position).gap);
                }
            }
        }
        self.last.0 = time;
        self.last.1.clear();
        self.last.1.extend_from_slice(samples);
    }

    /// The verdict.
    #[must_use]
    pub fn summary(&self, scenario: &Scenario) -> Summary {
        let cases = scenario.cases();
        Summary {
            name: scenario.name.clone(),
            section: scenario.section.clone(),
            duration: self.last.0,
            step: scenario.timing.step,
            cases: cases.iter().enumerate().map(|(case, (_, label))| self.case(scenario, case, label)).collect(),
        }
    }

    fn case(&self, scenario: &Scenario, case: usize, label: &str) -> CaseSummary {
        let (end, samples) = &self.last;
        // Seen away from it at the very end, or at no time.
        let since = |last: f64| (last < *end).then_some(if last < 0.0 { 0.0 } else { last + scenario.timing.step });
        let rows = self.seats.iter().zip(samples).enumerate().filter(|(_, (seat, _))| seat.case == case);
        let robots: Vec<RobotSummary> = rows
            .map(|(index, (seat, sample))| {
                let is_unicycle = matches!(scenario.task, Task::Regulating(_));
                let leader = seat.leader.map(|leader| (samples[leader].position - sample.position).norm());
                RobotSummary {
                    name: seat.name.clone(),
                    position: pair(sample.position),
                    error: sample.deviation,
                    conforms_after: since(self.last_away[index]),
                    leader_distance: leader,
                    leader_distance_range: seat.leader.map(|_| self.leader_range[index]),
                    misalignment: is_unicycle.then_some(sample.misalignment),
                    resting_misalignment: resting(scenario, case, seat.rank),
                    effort: is_unicycle.then_some(sample.effort),
                    lyapunov: self.lyapunov[index],
                }
            })
            .collect();
        let all = robots.iter().map(|robot| robot.conforms_after).collect::<Option<Vec<f64>>>();
        let has_leaders = robots.iter().any(|robot| robot.leader_distance.is_some());
        CaseSummary {
            label: label.to_owned(),
            conforms_after: all.map(|times| times.into_iter().fold(0.0, f64::max)),
            closest_pair: (robots.len() > 1).then_some(self.closest[case].least()),
            obstacles: self.gaps[case].iter().map(|&(id, least_gap)| ObstacleSummary { id, least_gap }).collect(),
            neutral_after: if has_leaders { since(self.last_outside[case]) } else { None },
            in_zone_1: self.in_zone_1[case],
            robots,
        }
    }
}

fn resting(scenario: &Scenario, case: usize, rank: usize) -> Option<f64> {
    let Task::Regulating(task) = &scenario.task else { return None };
    let ChosenLaw::Robust(gains) = task.cases.get(case)?.law else { return None };
    let start = task.starts.get(rank - 1)?.0;
    Some(final_misalignment(gains, trench_formation::kinematics::Polar::of(start, task.goal).misalignment))
}

fn pair(vector: Vector2<f64>) -> [f64; 2] {
    [vector.x, vector.y]
}
