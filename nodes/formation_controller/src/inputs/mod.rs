//! The newest of everything the controller hears, with when it came.

mod goals;
mod hulls;
mod orders;
mod stamps;
mod teammates;
mod voices;

pub(crate) use goals::Said;
pub(crate) use hulls::Hulls;
pub(crate) use orders::Orders;
pub(crate) use teammates::{Ahead, Others, Spoken};
pub(crate) use voices::Voices;

use crate::ports::{APPARENT_OBSTACLES, GOALS, TEAM_STATE};
use crate::refusal::Refusal;
use crate::segments::Segments;
use stamps::timely;
use std::sync::Arc;
use trench_core::{RosTime, Steady, Times};
use trench_formation::Vector2;
use trench_msgs::msg::{Assignment, Identify, Member, Point2, RobotState, RunState, TeamState};

/// A message and the monotonic time of its receipt: ages that stop robots are measured by it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Heard<T> {
    pub(crate) at: Steady,
    pub(crate) message: T,
}

/// Between two ticks where that is not known yet, s.
const INTERVAL: f64 = 1.0 / 30.0;

/// What was heard last on each topic.
#[derive(Debug, Clone, Default)]
pub(crate) struct Inputs {
    pub(crate) team: Option<Heard<TeamState>>,
    /// Seconds between the exposures of the last two team states.
    interval: Option<f64>,
    pub(crate) goals: Said,
    /// What everybody says on the latched topics, from which the next three are chosen.
    pub(crate) orders: Orders,
    pub(crate) run: Option<RunState>,
    pub(crate) assignment: Option<Assignment>,
    pub(crate) segments: Option<Arc<Segments>>,
    pub(crate) obstacles: Option<Heard<Hulls>>,
    pub(crate) others: Others,
    pub(crate) voices: Voices,
    pub(crate) emergency_stop: bool,
    pub(crate) identify: Option<Heard<Identify>>,
    /// From an exposure to the wheels, s, as the localizer has measured it.
    pub(crate) loop_delay: Option<f64>,
}

impl Inputs {
    /// Takes a team state, unless it is older than the one before or from the future, or a number in it is none.
    ///
    /// # Errors
    /// Why it is refused.
    pub(crate) fn take_team(&mut self, at: Times, message: TeamState) -> Result<(), Refusal> {
        let stamp = RosTime::from(&message.header.stamp);
        let before = self.team.as_ref().map(|before| RosTime::from(&before.message.header.stamp));
        timely(at, stamp, before)?;
        if !message.is_finite() {
            return Err(Refusal::NotFinite);
        }
        if let Some(elapsed) = before.map(|before| stamp.seconds_since(before))
            && (0.005..0.2).contains(&elapsed)
        {
            self.interval = Some(elapsed);
        }
        self.team = Some(Heard { at: at.steady, message });
        Ok(())
    }

    /// Takes the mapper's hulls, unless they are late or no hulls.
    ///
    /// # Errors
    /// Why they are refused.
    pub(crate) fn take_hulls(&mut self, at: Times, message: Hulls) -> Result<(), Refusal> {
        timely(at, message.stamp, self.obstacles.as_ref().map(|before| before.message.stamp))?;
        self.obstacles = Some(Heard { at: at.steady, message });
        Ok(())
    }

    /// When that was which the newest message on this port tells of, where that drives the robot.
    pub(crate) fn stamp(&self, port: usize) -> Option<RosTime> {
        match port {
            TEAM_STATE => self.team.as_ref().map(|heard| RosTime::from(&heard.message.header.stamp)),
            GOALS => self.goals.stamp(),
            APPARENT_OBSTACLES => self.obstacles.as_ref().map(|heard| heard.message.stamp),
            _ => None,
        }
    }

    /// Seconds between ticks.
    pub(crate) fn interval(&self) -> f64 {
        self.interval.unwrap_or(INTERVAL)
    }

    /// The state of `robot` in the newest team state.
    pub(crate) fn robot(&self, robot: &str) -> Option<&RobotState> {
        self.team.as_ref()?.message.robots.iter().find(|state| state.name == robot)
    }

    /// Robots that are seen but have no place: they have died, or wait to join. To the others they are obstacles.
    pub(crate) fn strangers(&self, robot: &str) -> impl Iterator<Item = &RobotState> {
        let members = self.assignment.as_ref().map(|assignment| &assignment.members);
        let seen = self.team.iter().flat_map(|team| &team.message.robots).filter(move |other| other.name != robot);
        seen.filter(move |other| members.is_some_and(|members| members.iter().all(|member| member.robot != other.name)))
    }

    /// Where the other robots of a member's queue are seen, m, map.
    pub(crate) fn queue_seen(&self, member: &Member) -> impl Iterator<Item = Vector2<f64>> {
        let seen = self.mates(member).filter_map(|other| self.robot(&other.robot));
        seen.filter(|seen| seen.status != RobotState::STATUS_LOST).map(|seen| Vector2::new(seen.x, seen.y))
    }

    /// The place of `robot`, if the formation that it is in is known.
    pub(crate) fn member(&self, robot: &str) -> Option<&Member> {
        let (assignment, segments) = (self.assignment.as_ref()?, self.segments.as_ref()?);
        let members = (assignment.formation_hash == segments.formation_hash).then_some(&assignment.members)?;
        members.iter().find(|member| member.robot == robot)
    }

    /// The queue that `robot` belongs to.
    pub(crate) fn queue(&self, robot: &str) -> Option<u32> {
        let members = &self.assignment.as_ref()?.members;
        members.iter().find(|member| member.robot == robot).map(|member| member.queue)
    }

    /// The other robots of a member's queue.
    pub(crate) fn mates(&self, member: &Member) -> impl Iterator<Item = &Member> {
        let members = self.assignment.iter().flat_map(|assignment| &assignment.members);
        members.filter(|other| other.queue == member.queue && other.robot != member.robot)
    }

    /// How many robots of its chain come behind `member`.
    pub(crate) fn members_behind(&self, member: &Member) -> usize {
        self.mates(member).filter(|other| other.rank > member.rank).count()
    }

    /// Those ahead of `member` in its chain, its leader last.
    pub(crate) fn members_ahead(&self, member: &Member) -> impl Iterator<Item = &Member> {
        self.mates(member).filter(|other| other.rank < member.rank)
    }
}

/// A point of a message as a vector.
pub(crate) fn vector(point: &Point2) -> Vector2<f64> {
    Vector2::new(point.x, point.y)
}

/// A vector as a point of a message.
pub(crate) fn point(vector: Vector2<f64>) -> Point2 {
    Point2 { x: vector.x, y: vector.y }
}
