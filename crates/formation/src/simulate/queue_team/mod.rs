//! A queue under the linear laws (8.7) and (8.11), while robots quit and join (A.22), links break (Remark 8.4.1) and robots out of its reach
//! come to it (Remark 6.2.1).
mod order;
mod scenario;

pub use scenario::{BrokenLink, QueueChange, QueueEvent, QueueRobotScenario, QueueScenario, Quitting, Recovery};

use super::Integration;
use super::integrate::Integrator;
use crate::Vector2;
use crate::kinematics::PointState;
use crate::laws::QueueFollowing;
use order::Order;

/// Nearer than this (m, along the segment) to the first place a robot that is lost has arrived.
const ARRIVED: f64 = 0.01;

/// A queue under way.
#[derive(Debug, Clone)]
pub struct QueueTeam {
    scenario: QueueScenario,
    /// Arc length of the first place, m.
    first: f64,
    robots: Vec<PointState>,
    order: Order,
    duties: Vec<Duty>,
    changes: Vec<QueueChange>,
    integrator: Integrator,
    step: f64,
    steps: u64,
}

/// What a robot does until something changes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Duty {
    /// It keeps to a point, m.
    Stays(Vector2<f64>),
    /// (8.7): it goes to its place, m.
    Place(Vector2<f64>),
    /// (8.11): it follows the robot of an index with a vector between them, m.
    Follows(usize, Vector2<f64>),
    /// Along the segment to the first place.
    Lost,
}

impl QueueTeam {
    /// Robots at their start.
    pub fn new(scenario: QueueScenario, method: Integration, step: f64) -> Self {
        let robots: Vec<PointState> = scenario.robots.iter().map(|robot| robot.start).collect();
        let duties = robots.iter().map(|robot| Duty::Stays(robot.position)).collect();
        let members = (0..robots.len()).filter(|index| scenario.robots[*index].joins.is_none());
        let mut team = Self {
            first: scenario.first_place(),
            order: Order::new(members),
            duties,
            changes: Vec::new(),
            integrator: Integrator::new(method, step, robots.len()),
            robots,
            scenario,
            step,
            steps: 0,
        };
        team.change();
        team
    }

    /// Advances by one step.
    pub fn step(&mut self) {
        let Self { scenario, duties, first, step, .. } = self;
        self.integrator.advance(&mut self.robots, 0.0, |_, robots, rates| {
            for (index, ((robot, duty), rate)) in robots.iter().zip(&*duties).zip(rates).enumerate() {
                let wanted = scenario.acceleration(robots, *robot, *duty, *first);
                *rate = scenario.admitted(robots, index, wanted, *step);
            }
        });
        self.steps += 1;
        self.change();
    }

    /// What happens at this time: who quits and joins, which links are broken, and what everybody does from now on.
    fn change(&mut self) {
        let time = self.time();
        self.look_for_lost();
        // Half a step, so that rounding does not put an event off.
        let is_due = |at: f64| at <= time + 0.5 * self.step;
        let mut happened = Vec::new();
        for (index, robot) in self.scenario.robots.iter().enumerate() {
            if let Some(quitting) = robot.quits.filter(|quitting| is_due(quitting.at))
                && self.order.remove(index, quitting.closes_up)
            {
                self.duties[index] = Duty::Stays(quitting.to);
                happened.push((index, QueueEvent::Quits));
            }
            let waits = matches!(self.duties[index], Duty::Stays(_)) && self.order.rank(index).is_none();
            let comes = waits && robot.joins.is_some_and(is_due) && !robot.quits.is_some_and(|quits| is_due(quits.at));
            let reaches = self.duties[index] == Duty::Lost && self.reaches_somebody(index);
            if comes || reaches {
                let members: Vec<Vector2<f64>> =
                    self.order.members().map(|(other, _)| self.robots[other].position).collect();
                let rank = self.order.join(index, self.robots[index].position, self.place(0), &members);
                happened.push((index, QueueEvent::Joins(rank + 1)));
            }
        }
        let is_broken = |index: usize| {
            let broken = |link: &BrokenLink| link.robot == index && is_due(link.from) && !is_due(link.to);
            self.scenario.broken.iter().any(broken)
        };
        let mut ahead: Option<(usize, u32)> = None;
        for (index, slot) in self.order.members() {
            // Those behind a break follow the first of them: teams of their own on one queue, as the remark says.
            let cut = is_broken(index);
            let place = self.place(slot);
            let duty = match ahead.filter(|_| !cut) {
                None => Duty::Place(place),
                Some((leader, slot)) => Duty::Follows(leader, self.place(slot) - place),
            };
            match (self.duties[index], duty) {
                (Duty::Follows(..), Duty::Place(_)) if cut => happened.push((index, QueueEvent::Retargets)),
                (Duty::Place(_), Duty::Follows(..)) => happened.push((index, QueueEvent::Follows)),
                _ => {}
            }
            self.duties[index] = duty;
            ahead = Some((index, slot));
        }
        self.changes.extend(happened.into_iter().map(|(robot, event)| QueueChange { time, robot, event }));
    }

    /// Who does not reach the first robot, be it over others of the queue, is not of it.
    fn look_for_lost(&mut self) {
        let Some(Recovery { range, .. }) = self.scenario.recovery else { return };
        let mut unreached = self.queue();
        if unreached.is_empty() {
            return;
        }
        let mut reached = vec![unreached.remove(0)];
        while let Some(from) = reached.pop() {
            let near = |other: usize| (self.robots[other].position - self.robots[from].position).norm() <= range;
            unreached.retain(|other| {
                let is_near = near(*other);
                if is_near {
                    reached.push(*other);
                }
                !is_near
            });
        }
        for index in unreached {
            self.order.remove(index, true);
            self.duties[index] = Duty::Lost;
            self.changes.push(QueueChange { time: self.time(), robot: index, event: QueueEvent::Lost });
        }
    }

    /// Whether a robot reaches one of the queue, all of which reach the first.
    fn reaches_somebody(&self, index: usize) -> bool {
        let Some(Recovery { range, .. }) = self.scenario.recovery else { return false };
        let near = |other: usize| (self.robots[other].position - self.robots[index].position).norm() <= range;
        self.order.members().any(|(other, _)| other != index && near(other))
    }

    /// A place, counted from the first one on, m.
    fn place(&self, slot: u32) -> Vector2<f64> {
        self.scenario.segment.at(self.first - f64::from(slot) * self.scenario.spacing).point
    }

    /// Seconds simulated.
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.step
    }

    /// The robots, as the scenario has them.
    pub fn robots(&self) -> &[PointState] {
        &self.robots
    }

    /// Acceleration of a robot, m/s^2, and the point that draws it, m: e of (8.6) or (8.9) is the way there.
    pub fn drawn(&self, index: usize) -> (Vector2<f64>, Vector2<f64>) {
        let (robot, duty) = (self.robots[index], self.duties[index]);
        let point = match duty {
            Duty::Stays(point) | Duty::Place(point) => point,
            Duty::Follows(leader, between) => self.robots[leader].position - between,
            Duty::Lost => self.scenario.segment.nearest(robot.position).point,
        };
        (self.scenario.acceleration(&self.robots, robot, duty, self.first), point)
    }

    /// The queue as it is: indices of its robots by rank.
    pub fn queue(&self) -> Vec<usize> {
        self.order.members().map(|(index, _)| index).collect()
    }

    /// All that has befallen it, in time.
    pub fn changes(&self) -> &[QueueChange] {
        &self.changes
    }
}

impl QueueScenario {
    /// Arc length of the first place, m.
    pub fn first_place(&self) -> f64 {
        self.segment.nearest(self.target).arc_length
    }

    /// Whether the robots are the same all the time, in the order of the scenario.
    pub fn is_settled(&self) -> bool {
        self.recovery.is_none() && self.robots.iter().all(|robot| robot.joins.is_none() && robot.quits.is_none())
    }

    fn acceleration(&self, robots: &[PointState], robot: PointState, duty: Duty, first: f64) -> Vector2<f64> {
        match duty {
            Duty::Stays(point) | Duty::Place(point) => {
                self.law.acceleration(robot, PointState::at_rest(point), Vector2::zeros())
            }
            Duty::Follows(leader, between) => self.law.acceleration(robot, robots[leader], between),
            Duty::Lost => {
                let foot = self.segment.nearest(robot.position);
                let fastest = self.recovery.map_or(0.0, |recovery| recovery.speed);
                let left = self.segment.way(foot.arc_length, first);
                let along = if left.abs() < ARRIVED { 0.0 } else { fastest * left.signum() };
                let tangent = self.segment.at(self.segment.ahead(foot.arc_length, left)).tangent;
                // The linear law for a foot that moves on, but for the speed: the way there is taken at the greatest.
                let QueueFollowing { position_gain, velocity_gain } = self.law;
                let wanted = along * tangent + position_gain / velocity_gain * (foot.point - robot.position);
                velocity_gain * (wanted.cap_magnitude(fastest) - robot.velocity)
            }
        }
    }
}
