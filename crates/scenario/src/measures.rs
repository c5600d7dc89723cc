//! How a run went, looked at after every step.

use crate::collisions::Collision;
use crate::divergence::Divergence;
use crate::four::Now;
use crate::neutral::outside;
use crate::robots::Robots;
use crate::summary::{
    CaseSummary, ChangeSummary, CollisionSummary, DivergedSummary, ObstacleSummary, OutsideSummary, RobotSummary,
    Summary, WheelSummary,
};
use crate::team::{Among, Team};
use crate::transits::Watch;
use crate::{ChosenLaw, Sample, Scenario, Seat, Simulation, Task};
use std::ops::Range;
use trench_formation::Vector2;
use trench_formation::kinematics::PointState;
use trench_formation::simulate::{QueueChange, QueueEvent, WheelEffort};
use trench_formation::stability::final_misalignment;
use trench_formation::zoning::Zoning;

/// What is kept between steps.
#[derive(Debug, Clone)]
pub struct Measures {
    seats: Vec<Seat>,
    /// s.
    time: f64,
    /// By case.
    teams: Vec<Team>,
    copies: Vec<PointState>,
    changes: Vec<ChangeSummary>,
    transits: Option<Watch>,
    divergence: Divergence,
    /// By seat, where robots have motors.
    wheels: Vec<Option<WheelSummary>>,
}

impl Measures {
    /// Before the first step.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        let seats = scenario.seats();
        let mut ranges: Vec<Range<usize>> = scenario.cases().iter().map(|_| 0..0).collect();
        for (index, seat) in seats.iter().enumerate() {
            let range = &mut ranges[seat.case];
            *range = if range.end == 0 { index } else { range.start }..index + 1;
        }
        Self {
            time: 0.0,
            teams: ranges.into_iter().map(|range| Team::new(&seats, range)).collect(),
            copies: Vec::new(),
            changes: Vec::new(),
            transits: Watch::new(scenario),
            divergence: Divergence::new(scenario),
            wheels: vec![None; seats.len()],
            seats,
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
        let zoning = scenario.zoning();
        let now = Now {
            time: simulation.time(),
            before: self.time,
            step: scenario.timing.step,
            tolerance: scenario.tolerance,
            neutral: Now::neutral(zoning.map(Zoning::radii)),
        };
        self.time = now.time;
        for change in simulation.changes().iter().skip(self.changes.len()) {
            self.changes.push(told(change, &self.seats));
            // Another leader, or none, is another V.
            for team in self.teams.iter_mut().filter(|team| team.seats().contains(&change.robot)) {
                team.begin_anew(change.robot - team.seats().start);
            }
        }
        let among = Among { seats: &self.seats, zoning, obstacles: simulation.obstacles().unwrap_or_default() };
        let Self { teams, divergence, transits, copies, .. } = self;
        for team in teams {
            team.look(robots, (&among, &now), divergence, transits.as_mut(), copies);
        }
        for (case, team) in self.teams.iter().enumerate() {
            for (index, effort) in simulation.wheel_efforts(case).iter().enumerate() {
                let WheelEffort { greatest, saturated } = *effort;
                self.wheels[team.seats().start + index] = Some(WheelSummary { greatest_torque: greatest, saturated });
            }
        }
    }

    /// The first robot that was out of all bounds: to go on says no more.
    #[must_use]
    pub fn diverged(&self) -> Option<&DivergedSummary> {
        self.divergence.first()
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
            diverged: self.diverged().cloned(),
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
                let (team, place) = (&self.teams[case], index - self.teams[case].seats().start);
                let [away, drawn] = team.last(place, self.time);
                let leader = seat.leader.map(|leader| (samples[leader].position - sample.position).norm());
                RobotSummary {
                    name: seat.name.clone(),
                    position: pair(sample.position),
                    error: sample.deviation,
                    conforms_after: since(away),
                    no_fragment_since: since(drawn),
                    leader_distance: leader,
                    leader_distance_range: seat.leader.map(|_| team.leader_range(place)),
                    misalignment: is_unicycle.then_some(sample.misalignment),
                    resting_misalignment: resting(scenario, case, seat.rank),
                    effort: is_unicycle.then_some(sample.effort),
                    transits: self.transits.as_ref().and_then(|watch| watch.of(index, sample.position, self.time)),
                    wheels: self.wheels[index],
                    lyapunov: sample.lyapunov.map(|[last, _]| team.lyapunov(place, last, scenario.timing.step)),
                }
            })
            .collect();
        let all = robots.iter().map(|robot| robot.conforms_after).collect::<Option<Vec<f64>>>();
        // A queue of chapter 8 has leaders, but no zones.
        let has_leaders = scenario.zoning().is_some() && robots.iter().any(|robot| robot.leader_distance.is_some());
        let outside_neutral =
            scenario.zoning().map_or(Vec::new(), |zoning| self.outside(scenario, samples, case, zoning));
        CaseSummary {
            label: label.to_owned(),
            conforms_after: all.map(|times| times.into_iter().fold(0.0, f64::max)),
            closest_pair: (robots.len() > 1).then_some(self.teams[case].closest.least()),
            obstacles: self.teams[case]
                .gaps
                .least()
                .iter()
                .map(|&(id, least_gap)| ObstacleSummary { id, least_gap })
                .collect(),
            collisions: self.collisions(case),
            changes: self.changes.clone(),
            neutral_after: if has_leaders { since(self.teams[case].last_outside) } else { None },
            outside_neutral,
            in_zone_1: scenario.zoning().map(|_| self.teams[case].in_zone_1),
            robots,
        }
    }

    fn collisions(&self, case: usize) -> Vec<CollisionSummary> {
        let team = &self.teams[case];
        let told = |Collision { time, robot, obstacle, stayed, times }: Collision| CollisionSummary {
            time,
            robot: self.seats[team.seats().start + robot].name.clone(),
            obstacle,
            way: if stayed { "into" } else { "through" },
            times,
        };
        team.gaps.collisions().iter().copied().map(told).collect()
    }

    /// Whose leaders are not in their neutral zones at the end.
    fn outside(&self, scenario: &Scenario, samples: &[Sample], case: usize, zoning: &Zoning) -> Vec<OutsideSummary> {
        let rows = self.seats.iter().zip(samples).filter(|(seat, _)| seat.case == case);
        let led = rows.filter_map(|row| {
            let leader = row.0.leader?;
            outside(row, (self.seats.get(leader)?, samples.get(leader)?), zoning, scenario.tolerance)
        });
        led.collect()
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
