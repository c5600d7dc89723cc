//! How a run went, looked at after every step.

use crate::closest::Closest;
use crate::course::Course;
use crate::divergence::Divergence;
use crate::gaps::Gaps;
use crate::neutral::outside;
use crate::robots::Robots;
use crate::summary::{
    CaseSummary, ChangeSummary, DivergedSummary, ObstacleSummary, OutsideSummary, RobotSummary, Summary, WheelSummary,
};
use crate::transits::Watch;
use crate::{ChosenLaw, Sample, Scenario, Seat, Simulation, Task};
use std::ops::Range;
use trench_formation::Vector2;
use trench_formation::kinematics::PointState;
use trench_formation::simulate::{QueueChange, QueueEvent, WheelEffort};
use trench_formation::stability::final_misalignment;
use trench_formation::zoning::{Zone, Zoning};

/// Robots that are looked at in one go, for all that is measured of them: so many stay in the nearest cache.
const BLOCK: usize = 256;

/// What is kept between steps.
#[derive(Debug, Clone)]
pub struct Measures {
    seats: Vec<Seat>,
    /// s.
    time: f64,
    /// By seat.
    kept: Vec<Kept>,
    /// By case.
    teams: Vec<Team>,
    copies: Vec<PointState>,
    changes: Vec<ChangeSummary>,
    transits: Option<Watch>,
    divergence: Divergence,
    /// By seat, where robots have motors.
    wheels: Vec<Option<WheelSummary>>,
}

/// Of a robot.
#[derive(Debug, Clone, Copy)]
struct Kept {
    /// Index of its leader.
    leader: Option<u32>,
    /// When it was last away from what draws it, s; negative: never.
    last_away: f64,
    /// When something last drew it, s; negative: never.
    last_drawn: f64,
    /// Least and greatest, m.
    leader_range: [f64; 2],
    lyapunov: Course,
}

/// Of the robots of a case, which stand together.
#[derive(Debug, Clone)]
struct Team {
    seats: Range<usize>,
    closest: Closest,
    gaps: Gaps,
    /// When a robot was last outside its leader's neutral zone, s; negative: never.
    last_outside: f64,
    /// s.
    in_zone_1: f64,
}

impl Measures {
    /// Before the first step.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        let seats = scenario.seats();
        let kept = |seat: &Seat| Kept {
            leader: seat.leader.map(|leader| leader as u32),
            last_away: -1.0,
            last_drawn: -1.0,
            leader_range: [f64::INFINITY, 0.0],
            lyapunov: Course::new(),
        };
        let mut teams: Vec<Team> = scenario.cases().iter().map(|_| Team::new()).collect();
        for (index, seat) in seats.iter().enumerate() {
            let team = &mut teams[seat.case].seats;
            *team = if team.end == 0 { index } else { team.start }..index + 1;
        }
        Self {
            time: 0.0,
            kept: seats.iter().map(kept).collect(),
            teams,
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
        let (time, zoning, obstacles) = (simulation.time(), scenario.zoning(), simulation.obstacles());
        self.time = time;
        for change in simulation.changes().iter().skip(self.changes.len()) {
            self.changes.push(told(change, &self.seats));
            // Another leader, or none, is another V.
            if let Some(kept) = self.kept.get_mut(change.robot) {
                kept.lyapunov.begin_anew();
            }
        }
        for Team { seats, closest, gaps, last_outside, in_zone_1 } in &mut self.teams {
            let points = robots.points(seats.start, seats.end, &mut self.copies);
            let has_pairs = closest.prepare(points, zoning);
            gaps.prepare(obstacles.unwrap_or_default(), points);
            for first in seats.clone().step_by(BLOCK) {
                let block = first..seats.end.min(first + BLOCK);
                for (index, kept) in block.clone().zip(&mut self.kept[block.clone()]) {
                    self.divergence.look(&self.seats[index], robots.position(index), time);
                    let outside = kept.look(robots, index, (time, scenario.timing.step, scenario.tolerance), zoning);
                    *last_outside = if outside { time } else { *last_outside };
                }
                let block = block.start - seats.start..block.end - seats.start;
                if has_pairs {
                    closest.take(points, block.clone(), zoning, || *in_zone_1 += scenario.timing.step);
                }
                gaps.take(points, block);
            }
        }
        if let Some(watch) = &mut self.transits {
            watch.look(robots, time);
        }
        for (case, team) in self.teams.iter().enumerate() {
            for (index, effort) in simulation.wheel_efforts(case).iter().enumerate() {
                let WheelEffort { greatest, saturated } = *effort;
                self.wheels[team.seats.start + index] = Some(WheelSummary { greatest_torque: greatest, saturated });
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
                let leader = seat.leader.map(|leader| (samples[leader].position - sample.position).norm());
                RobotSummary {
                    name: seat.name.clone(),
                    position: pair(sample.position),
                    error: sample.deviation,
                    conforms_after: since(self.kept[index].last_away),
                    no_fragment_since: since(self.kept[index].last_drawn),
                    leader_distance: leader,
                    leader_distance_range: seat.leader.map(|_| self.kept[index].leader_range),
                    misalignment: is_unicycle.then_some(sample.misalignment),
                    resting_misalignment: resting(scenario, case, seat.rank),
                    effort: is_unicycle.then_some(sample.effort),
                    transits: self.transits.as_ref().and_then(|watch| watch.of(index, sample.position, self.time)),
                    wheels: self.wheels[index],
                    lyapunov: sample.lyapunov.map(|[last, _]| self.kept[index].lyapunov.summary(last)),
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
            changes: self.changes.clone(),
            neutral_after: if has_leaders { since(self.teams[case].last_outside) } else { None },
            outside_neutral,
            in_zone_1: self.teams[case].in_zone_1,
            robots,
        }
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

impl Kept {
    /// Looks at the robot at `time` (s), a `step` (s) after the last time, which conforms within `tolerance` (m); whether it is outside its leader's neutral zone.
    #[inline]
    fn look(
        &mut self,
        robots: &(impl Robots + ?Sized),
        index: usize,
        (time, step, tolerance): (f64, f64, f64),
        zoning: Option<&Zoning>,
    ) -> bool {
        let deviation = robots.deviation(index);
        if deviation.is_nan() || deviation > tolerance {
            self.last_away = time;
        }
        if deviation.is_finite() {
            self.last_drawn = time;
        }
        if let Some(moment) = robots.lyapunov(index) {
            self.lyapunov.take(moment, step, robots.is_drawn(index));
        } else {
            self.lyapunov.begin_anew();
        }
        let Some(leader) = self.leader else { return false };
        let distance = (robots.position(leader as usize) - robots.position(index)).norm();
        self.leader_range = [self.leader_range[0].min(distance), self.leader_range[1].max(distance)];
        zoning.is_some_and(|zoning| zoning.zone(distance) != Zone::Neutral)
    }
}

impl Team {
    fn new() -> Self {
        Self { seats: 0..0, closest: Closest::default(), gaps: Gaps::default(), last_outside: -1.0, in_zone_1: 0.0 }
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
