//! How a run went, looked at after every step.

use crate::closest::Closest;
use crate::gaps::Gaps;
use crate::robots::Robots;
use crate::summary::{
    CaseSummary, ChangeSummary, LyapunovSummary, ObstacleSummary, RobotSummary, Summary, WheelSummary,
};
use crate::transits::Watch;
use crate::{ChosenLaw, Sample, Scenario, Seat, Simulation, Task};
use trench_formation::Vector2;
use trench_formation::kinematics::PointState;
use trench_formation::simulate::{QueueChange, QueueEvent, WheelEffort};
use trench_formation::stability::final_misalignment;
use trench_formation::zoning::Zone;

/// What is kept between steps.
#[derive(Debug, Clone)]
pub struct Measures {
    seats: Vec<Seat>,
    /// s.
    time: f64,
    last_away: Vec<f64>,
    leader_range: Vec<[f64; 2]>,
    /// Greatest Lyapunov function and greatest rate of it.
    lyapunov: Vec<[f64; 2]>,
    /// By case.
    closest: Vec<Closest>,
    /// By case.
    gaps: Vec<Gaps>,
    last_outside: Vec<f64>,
    in_zone_1: Vec<f64>,
    copies: Vec<PointState>,
    changes: Vec<ChangeSummary>,
    transits: Option<Watch>,
    /// By seat, where robots have motors.
    wheels: Vec<Option<WheelSummary>>,
}

impl Measures {
    /// Before the first step.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        let (seats, cases) = (scenario.seats(), scenario.cases().len());
        let count = seats.len();
        Self {
            seats,
            time: 0.0,
            last_away: vec![-1.0; count],
            leader_range: vec![[f64::INFINITY, 0.0]; count],
            lyapunov: vec![[f64::NEG_INFINITY; 2]; count],
            closest: vec![Closest::default(); cases],
            gaps: vec![Gaps::default(); cases],
            last_outside: vec![-1.0; cases],
            in_zone_1: vec![0.0; cases],
            copies: Vec::new(),
            changes: Vec::new(),
            transits: Watch::new(scenario),
            wheels: vec![None; count],
        }
    }

    /// Looks at all robots, before the first step and after each. `samples` are of now; where [`Simulation::tells_itself`] nobody looks
    /// at them.
    pub fn take(&mut self, scenario: &Scenario, simulation: &Simulation, samples: &[Sample]) {
        match simulation.alone() {
            Some(chain) => self.look(scenario, simulation, chain),
            None => self.look(scenario, simulation, samples),
        }
    }

    /// [`Self::take`] by samples alone, whatever is simulated.
    pub fn take_samples(&mut self, scenario: &Scenario, simulation: &Simulation, samples: &[Sample]) {
        self.look(scenario, simulation, samples);
    }

    fn look(&mut self, scenario: &Scenario, simulation: &Simulation, robots: &(impl Robots + ?Sized)) {
        let (time, zoning, obstacles) = (simulation.time(), scenario.zoning(), simulation.obstacles());
        self.time = time;
        let kept = self.last_away.iter_mut().zip(&mut self.leader_range).zip(&mut self.lyapunov);
        for (index, (seat, ((last_away, leader_range), lyapunov))) in self.seats.iter().zip(kept).enumerate() {
            let deviation = robots.deviation(index);
            if deviation.is_nan() || deviation > scenario.tolerance {
                *last_away = time;
            }
            if let Some([value, rate]) = robots.lyapunov(index) {
                *lyapunov = [lyapunov[0].max(value), lyapunov[1].max(rate)];
            }
            if let Some(watch) = &mut self.transits {
                watch.look(index, robots.position(index), time);
            }
            if let Some(leader) = seat.leader {
                let distance = (robots.position(leader) - robots.position(index)).norm();
                *leader_range = [leader_range[0].min(distance), leader_range[1].max(distance)];
                if zoning.is_some_and(|zoning| zoning.zone(distance) != Zone::Neutral) {
                    self.last_outside[seat.case] = time;
                }
            }
        }
        for change in simulation.changes().iter().skip(self.changes.len()) {
            self.changes.push(told(change, &self.seats));
        }
        // Robots of a case stand together.
        let mut first = 0;
        for team in self.seats.chunk_by(|seat, next| seat.case == next.case) {
            let (case, end) = (team[0].case, first + team.len());
            let team = robots.points(first, end, &mut self.copies);
            let in_zone_1 = &mut self.in_zone_1[case];
            self.closest[case].take(team, zoning, || *in_zone_1 += scenario.timing.step);
            if let Some(real) = obstacles {
                self.gaps[case].take(real, team);
            }
            for (index, effort) in simulation.wheel_efforts(case).iter().enumerate() {
                let WheelEffort { greatest, saturated } = *effort;
                self.wheels[first + index] = Some(WheelSummary { greatest_torque: greatest, saturated });
            }
            first = end;
        }
    }

    /// The verdict; `samples` are of the end.
    #[must_use]
    pub fn summary(&self, scenario: &Scenario, samples: &[Sample]) -> Summary {
        let cases = scenario.cases();
        Summary {
            name: scenario.name.clone(),
            section: scenario.section.clone(),
            duration: self.time,
            step: scenario.timing.step,
            cases: cases
                .iter()
                .enumerate()
                .map(|(case, (_, label))| self.case(scenario, samples, (case, label)))
                .collect(),
        }
    }

    fn case(&self, scenario: &Scenario, samples: &[Sample], (case, label): (usize, &str)) -> CaseSummary {
        // Seen away from it at the very end, or at no time.
        let since =
            |last: f64| (last < self.time).then_some(if last < 0.0 { 0.0 } else { last + scenario.timing.step });
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
                    transits: self.transits.as_ref().and_then(|watch| watch.of(index)),
                    wheels: self.wheels[index],
                    lyapunov: sample.lyapunov.map(|[last, _]| {
                        let [greatest, greatest_rate] = self.lyapunov[index];
                        LyapunovSummary { greatest, last, greatest_rate }
                    }),
                }
            })
            .collect();
        let all = robots.iter().map(|robot| robot.conforms_after).collect::<Option<Vec<f64>>>();
        // A queue of chapter 8 has leaders, but no zones.
        let has_leaders = scenario.zoning().is_some() && robots.iter().any(|robot| robot.leader_distance.is_some());
        CaseSummary {
            label: label.to_owned(),
            conforms_after: all.map(|times| times.into_iter().fold(0.0, f64::max)),
            closest_pair: (robots.len() > 1).then_some(self.closest[case].least()),
            obstacles: self.gaps[case]
                .least()
                .iter()
                .map(|&(id, least_gap)| ObstacleSummary { id, least_gap })
                .collect(),
            changes: self.changes.clone(),
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

fn told(change: &QueueChange, seats: &[Seat]) -> ChangeSummary {
    let (change_to, rank) = match change.event {
        QueueEvent::Joins(rank) => ("joins", Some(rank)),
        QueueEvent::Quits => ("quits", None),
        QueueEvent::Lost => ("lost", None),
        QueueEvent::Retargets => ("retargets", None),
        QueueEvent::Follows => ("follows", None),
    };
    let robot = seats.get(change.robot).map_or_else(String::new, |seat| seat.name.clone());
    ChangeSummary { time: change.time, robot, change: change_to, rank }
}

fn pair(vector: Vector2<f64>) -> [f64; 2] {
    [vector.x, vector.y]
}
