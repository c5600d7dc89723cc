//! What is simulated of a queue under the linear laws.
use crate::Vector2;
use crate::curve::Curve;
use crate::kinematics::PointState;
use crate::laws::{Capability, QueueFollowing};
use crate::safety::Stopping;

/// A queue of chapter 8, and what befalls it.
#[derive(Debug, Clone, PartialEq)]
pub struct QueueScenario {
    /// Its segment, at rest.
    pub segment: Curve,
    /// The queue's target, m: the first place is where the segment is nearest to it, the others lie before that.
    pub target: Vector2<f64>,
    /// m, along the segment, between two places.
    pub spacing: f64,
    /// (8.7) of the first robot, (8.11) of the others, realisable.
    pub law: QueueFollowing,
    /// Those without a time at which they join are the queue at time 0, by rank.
    pub robots: Vec<QueueRobotScenario>,
    /// Links that break.
    pub broken: Vec<BrokenLink>,
    /// How robots out of reach come to the queue; without it nobody is.
    pub recovery: Option<Recovery>,
    /// What robots can do; without it whatever the law asks for.
    pub limits: Option<Capability>,
    /// Whether the law ends in the safety filter: robots are bodies that do not touch. With it, as with limits, accelerations are held for a step.
    pub safety: Option<Stopping>,
}

impl QueueScenario {
    /// What limits and safety filter leave of the acceleration that the law of the robot of an index asks for, for a step of `step` (s).
    pub(super) fn admitted(
        &self,
        robots: &[PointState],
        index: usize,
        wanted: Vector2<f64>,
        step: f64,
    ) -> Vector2<f64> {
        let wanted = self.limits.map_or(wanted, |limits| limits.admit(robots[index].velocity, wanted, step));
        self.safety.map_or(wanted, |safety| safety.admit_among(robots, index, wanted, step))
    }
}

/// A robot of a queue, or one that comes to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QueueRobotScenario {
    /// At time 0.
    pub start: PointState,
    /// When it joins, s: until then it stays where it is.
    pub joins: Option<f64>,
    /// When it quits.
    pub quits: Option<Quitting>,
}

/// A robot that quits (A.22).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quitting {
    /// s.
    pub at: f64,
    /// Where it goes, m.
    pub to: Vector2<f64>,
    /// Whether those behind it take the places ahead of theirs (case 2.2); else its place stays empty (case 2.1).
    pub closes_up: bool,
}

/// A link that breaks for a time (Remark 8.4.1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BrokenLink {
    /// Index of the robot that loses sight of the one ahead of it.
    pub robot: usize,
    /// s.
    pub from: f64,
    /// s.
    pub to: f64,
}

impl BrokenLink {
    /// Whether it is broken at `time` (s).
    pub(in crate::simulate) fn holds(&self, time: f64) -> bool {
        self.from <= time && time < self.to
    }
}

/// Remark 6.2.1: a robot that does not reach the first of the queue, be it over others, goes to the segment and along it towards the team goal
/// until it reaches one that does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recovery {
    /// How far links reach, m.
    pub range: f64,
    /// The robots' greatest speed along the segment, m/s.
    pub speed: f64,
}

/// What befell a robot, and when.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QueueChange {
    /// s.
    pub time: f64,
    /// Its index.
    pub robot: usize,
    /// What.
    pub event: QueueEvent,
}

/// Changes of a queue's structure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum QueueEvent {
    /// It joins at a rank, from 1 on.
    Joins(usize),
    /// It quits.
    Quits,
    /// The queue is out of its reach (Remark 6.2.1); in a chain, its leader.
    Lost,
    /// Its link is broken: it goes to its place, which is that of the queue's target less those ahead (Remark 8.4.1), in a chain towards the team
    /// goal.
    Retargets,
    /// Its link is whole again, or somebody is ahead of it now: it follows the robot ahead.
    Follows,
}
