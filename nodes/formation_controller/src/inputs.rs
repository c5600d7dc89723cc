//! The newest of everything the controller hears, with when it came.

use crate::dynamic::{Ahead, Frame};
use crate::refusal::Refusal;
use crate::segments::Segments;
use std::collections::BTreeMap;
use std::sync::Arc;
use trench_core::{RosTime, Steady, Times};
use trench_formation::Vector2;
use trench_formation::kinematics::PointState;
use trench_formation::laws::GoalMotion;
use trench_msgs::msg::{
    ApparentObstacle, ApparentObstacleArray, Assignment, Goal, Goals, LeaderState, Member, Point2, RobotState,
    RunState, TeamState,
};

/// A message and the monotonic time of its receipt: ages that stop robots are measured by it.
#[derive(Debug, Clone)]
pub(crate) struct Heard<T> {
    pub(crate) at: Steady,
    pub(crate) message: T,
}

/// Messages this much older than the last one (s) are late; older ones are of a clock that was set back.
const PAST: f64 = 10.0;

/// A stamp may be this far ahead of our clock, s.
const FUTURE: f64 = 0.05;

/// Between two ticks where that is not known yet, s.
const INTERVAL: f64 = 1.0 / 30.0;

/// What was heard last on each topic.
#[derive(Debug, Clone, Default)]
pub(crate) struct Inputs {
    pub(crate) team: Option<Heard<TeamState>>,
    /// Seconds between the exposures of the last two team states.
    interval: Option<f64>,
    pub(crate) goals: Option<Heard<Goals>>,
    pub(crate) run: Option<RunState>,
    pub(crate) assignment: Option<Assignment>,
    pub(crate) segments: Option<Arc<Segments>>,
    pub(crate) obstacles: Option<Heard<Vec<Hull>>>,
    /// What the others say of themselves, whatever they follow.
    pub(crate) others: BTreeMap<String, Heard<LeaderState>>,
    /// What teammates say who follow the same assignment.
    teammates: BTreeMap<String, Heard<LeaderState>>,
    pub(crate) emergency_stop: bool,
}

/// An apparent obstacle as the safety filter wants it.
#[derive(Debug, Clone)]
pub(crate) struct Hull {
    pub(crate) points: Vec<Vector2<f64>>,
    pub(crate) radius: f64,
    pub(crate) velocity: Vector2<f64>,
}

impl Hull {
    /// Those of a message.
    pub(crate) fn all(message: &ApparentObstacleArray) -> Vec<Self> {
        let hull = |obstacle: &ApparentObstacle| Self {
            points: obstacle.hull.iter().map(vector).collect(),
            radius: obstacle.radius,
            velocity: vector(&obstacle.velocity),
        };
        message.obstacles.iter().map(hull).collect()
    }
}

impl Inputs {
    /// Takes a team state, unless it is older than the one before.
    ///
    /// # Errors
    /// Why it is refused.
    pub(crate) fn take_team(&mut self, at: Times, message: TeamState) -> Result<(), Refusal> {
        let stamp = RosTime::from(&message.header.stamp);
        if let Some(before) = &self.team {
            let elapsed = stamp.seconds_since(RosTime::from(&before.message.header.stamp));
            // A clock that was set back, or a bag that begins anew, is no message from the past.
            if (-PAST..0.0).contains(&elapsed) {
                return Err(Refusal::Past(-elapsed));
            }
            if (0.005..0.2).contains(&elapsed) {
                self.interval = Some(elapsed);
            }
        }
        self.team = Some(Heard { at: at.steady, message });
        Ok(())
    }

    /// Takes goals, unless they are of an assignment that was replaced.
    ///
    /// # Errors
    /// Why they are refused.
    pub(crate) fn take_goals(&mut self, at: Times, message: Goals) -> Result<(), Refusal> {
        let ours = self.assignment.as_ref().map_or(0, |assignment| assignment.epoch);
        if message.epoch < ours && message.epoch != 0 {
            return Err(Refusal::Epoch { theirs: message.epoch, ours });
        }
        self.goals = Some(Heard { at: at.steady, message });
        Ok(())
    }

    /// Takes what another robot says of itself; as a teammate it counts only under the same assignment and formation.
    ///
    /// # Errors
    /// Why it does not count.
    pub(crate) fn take_other(&mut self, at: Times, name: &str, message: LeaderState) -> Result<(), Refusal> {
        let judged = self.judge(at, name, &message);
        if judged.is_ok() {
            self.teammates.insert(name.to_owned(), Heard { at: at.steady, message: message.clone() });
        }
        if !matches!(judged, Err(Refusal::Past(_) | Refusal::Future(_) | Refusal::NotFinite)) {
            self.others.insert(name.to_owned(), Heard { at: at.steady, message });
        }
        judged
    }

    fn judge(&self, at: Times, name: &str, message: &LeaderState) -> Result<(), Refusal> {
        let numbers = [&message.point, &message.point_velocity].map(|point| point.x + point.y);
        if !(numbers[0] + numbers[1] + message.goal_distance).is_finite() {
            return Err(Refusal::NotFinite);
        }
        let stamp = RosTime::from(&message.header.stamp);
        let ahead = stamp.seconds_since(at.ros);
        if ahead > FUTURE {
            return Err(Refusal::Future(ahead));
        }
        if let Some(before) = self.others.get(name) {
            let elapsed = stamp.seconds_since(RosTime::from(&before.message.header.stamp));
            if (-PAST..0.0).contains(&elapsed) {
                return Err(Refusal::Past(-elapsed));
            }
        }
        let Some(assignment) = &self.assignment else { return Ok(()) };
        if message.epoch != assignment.epoch {
            return Err(Refusal::Epoch { theirs: message.epoch, ours: assignment.epoch });
        }
        if message.formation_hash != assignment.formation_hash {
            return Err(Refusal::Formation);
        }
        Ok(())
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

    /// The place of `robot`, if the formation that it is in is known.
    pub(crate) fn member(&self, robot: &str) -> Option<&Member> {
        let (assignment, segments) = (self.assignment.as_ref()?, self.segments.as_ref()?);
        let members = (assignment.formation_hash == segments.formation_hash).then_some(&assignment.members)?;
        members.iter().find(|member| member.robot == robot)
    }

    /// Those ahead of `member` in its chain, its leader last.
    pub(crate) fn members_ahead(&self, member: &Member) -> impl Iterator<Item = &Member> {
        let (queue, rank) = (member.queue, member.rank);
        let members = self.assignment.iter().flat_map(|assignment| &assignment.members);
        members.filter(move |other| other.queue == queue && other.rank < rank)
    }

    /// The robots whose leader states arrived within `age_limit` seconds, in order of name.
    pub(crate) fn hears(&self, now: Steady, age_limit: f64) -> impl Iterator<Item = &str> {
        let fresh = move |heard: &Heard<LeaderState>| now.seconds_since(heard.at) <= age_limit;
        self.others.iter().filter(move |(_, heard)| fresh(heard)).map(|(name, _)| name.as_str())
    }

    /// Whether one of the other robots of the queue of `member` is heard; a robot that has none is not missing any.
    pub(crate) fn hears_of_queue(&self, member: &Member, now: Steady, age_limit: f64) -> bool {
        let members = self.assignment.iter().flat_map(|assignment| &assignment.members);
        let mut mates = members.filter(|other| other.queue == member.queue && other.robot != member.robot).peekable();
        mates.peek().is_none() || mates.any(|mate| self.hears(now, age_limit).any(|name| name == mate.robot))
    }

    /// A robot ahead at `time`: what it said last, going on as it moved; none once it has been silent for `age_limit` seconds.
    pub(crate) fn teammate(&self, name: &str, (now, time): (Steady, RosTime), age_limit: f64) -> Option<Ahead> {
        let heard = self.teammates.get(name).filter(|heard| now.seconds_since(heard.at) <= age_limit)?;
        let said = &heard.message;
        let elapsed = time.seconds_since(RosTime::from(&said.header.stamp)).clamp(0.0, age_limit + INTERVAL);
        let velocity = vector(&said.point_velocity);
        let state = PointState { position: vector(&said.point) + elapsed * velocity, velocity };
        Some(Ahead { state, deviation: said.goal_distance })
    }

    /// The formation's frame at `time`.
    pub(crate) fn frame(&self, time: RosTime) -> Option<Frame> {
        let message = &self.goals.as_ref()?.message;
        let frame = &message.frame;
        let origin = GoalMotion {
            position: vector(&frame.position),
            velocity: vector(&frame.velocity),
            acceleration: vector(&frame.acceleration),
        };
        let frame = Frame { origin, theta: frame.theta, turn_rate: frame.turn_rate };
        Some(frame.after(time.seconds_since(RosTime::from(&message.header.stamp)).clamp(-1.0, 1.0)))
    }

    /// The goal of `robot` at `time`, if the goals are not older than `age_limit` seconds.
    pub(crate) fn goal(&self, robot: &str, time: RosTime, now: Steady, age_limit: f64) -> Option<(GoalMotion, u8)> {
        let heard = self.goals.as_ref().filter(|goals| now.seconds_since(goals.at) <= age_limit)?;
        let goal = heard.message.goals.iter().find(|goal| goal.robot == robot)?;
        let ahead = time.seconds_since(RosTime::from(&heard.message.header.stamp));
        Some((extrapolate(goal, ahead), goal.phase))
    }
}

/// The goal point `ahead` seconds after its stamp: it moves for `remaining` seconds and rests then.
fn extrapolate(goal: &Goal, ahead: f64) -> GoalMotion {
    let (velocity, acceleration) = (vector(&goal.velocity), vector(&goal.acceleration));
    let remaining = goal.remaining.max(0.0);
    let moved = ahead.min(remaining);
    let position = vector(&goal.position) + moved * velocity + 0.5 * moved * moved * acceleration;
    if ahead < remaining {
        GoalMotion { position, velocity: velocity + moved * acceleration, acceleration }
    } else {
        GoalMotion::at_rest(position)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goals_move_as_long_as_they_are_said_to() {
        let goal = Goal {
            position: Point2 { x: 1.0, y: 0.0 },
            velocity: Point2 { x: 0.1, y: 0.0 },
            remaining: 2.0,
            ..Default::default()
        };
        let check = |ahead, x: f64, speed: f64| {
            let motion = extrapolate(&goal, ahead);
            assert!((motion.position.x - x).abs() < 1e-12 && (motion.velocity.x - speed).abs() < 1e-12, "{motion:?}");
        };
        check(0.0, 1.0, 0.1);
        check(1.0, 1.1, 0.1);
        check(3.0, 1.2, 0.0);
    }

    #[test]
    fn old_goals_are_no_goals() {
        let goals = Goals { goals: vec![Goal { robot: "r".to_owned(), ..Default::default() }], ..Default::default() };
        let inputs = Inputs { goals: Some(Heard { at: Steady(0), message: goals }), ..Default::default() };
        assert!(inputs.goal("r", RosTime(0), Steady(400_000_000), 0.5).is_some());
        assert!(inputs.goal("r", RosTime(0), Steady(600_000_000), 0.5).is_none());
        assert!(inputs.goal("s", RosTime(0), Steady(0), 0.5).is_none());
    }
}
