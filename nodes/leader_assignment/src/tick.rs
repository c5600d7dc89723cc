//! What each team state brings: the frame of the formation, goal points, now and then a picture.

use crate::carrier::to_message;
use crate::core::{GOALS, LeaderAssignment, MARKERS};
use crate::organise::Seated;
use crate::target::TargetRefusal;
use crate::{Carrier, markers, virtual_point};
use trench_core::{Condition, Level, RosTime, Sink, Steady, Times};
use trench_formation::Vector2;
use trench_msgs::msg::{Goal, Goals, RobotState, TeamState};
use trench_msgs::std_msgs::Header;
use trench_msgs::visualization_msgs::MarkerArray;
use trench_plan::Frame;

/// The shortest time between two pictures for viewers, s; a tick that comes a little early counts as due.
const PICTURES: f64 = 0.195;

/// The bridge tells of each robot's link ten times a second; without a word of any for so long, s, it is silent.
const RADIO_SILENCE: f64 = 0.35;

const MAP: &str = "map";

/// Goals of all robots that may ever take part: no message is longer.
pub(crate) fn longest_goals(robots: &[String]) -> Goals {
    let goal = |robot: &String| Goal { robot: robot.clone(), ..Goal::default() };
    let header = Header { frame_id: MAP.to_owned(), ..Header::default() };
    Goals { header, goals: robots.iter().map(goal).collect(), ..Goals::default() }
}

impl LeaderAssignment {
    pub(crate) fn tick(&mut self, at: Times, team: TeamState, sink: &mut dyn Sink) {
        let stamp = RosTime::from(&team.header.stamp);
        self.target_among(at, stamp, &team, sink);
        self.members.seen(at, &team);
        self.tell_radio(at.steady);
        self.team = Some(team);
        self.follow_structure(at, sink);
        if self.unlocalised(&self.held.robots).is_empty() && self.run.localised(stamp) {
            self.announce(at, sink);
        }
        let goals = self.goals(at, stamp);
        if let Some(goals) = &goals {
            sink.publish(GOALS, goals);
        }
        self.draw(at, stamp, goals.as_ref(), sink);
    }

    /// Names a bridge that says nothing any more: nobody commands through it.
    fn tell_radio(&mut self, now: Steady) {
        let silent = self.linked.is_some_and(|heard| now.seconds_since(heard) > RADIO_SILENCE);
        if silent {
            let text = "nothing is heard of any robot's radio: rf_bridge or the air is silent";
            self.health.set("radio", Condition::Stale, text);
        } else if std::mem::replace(&mut self.radio_is_silent, false) {
            self.health.set("radio", Condition::Ok, "heard");
        }
        self.radio_is_silent |= silent;
    }

    /// Shows viewers the formation, now and then.
    fn draw(&mut self, at: Times, stamp: RosTime, goals: Option<&Goals>, sink: &mut dyn Sink) {
        let is_due = self.last_picture.is_none_or(|last| at.steady.seconds_since(last) >= PICTURES);
        let (true, Some(carrier), Some(team)) = (is_due, self.carrier(at.steady, stamp), &self.team) else { return };
        self.last_picture = Some(at.steady);
        let mut all = markers::of_plan(stamp.into(), &self.held.plan, &carrier);
        all.extend(goals.map(|goals| markers::of_goals(stamp.into(), goals)));
        let chains = self.assignment.iter().flat_map(|assignment| markers::of_chains(stamp.into(), team, assignment));
        all.extend(chains);
        sink.publish(MARKERS, &MarkerArray { markers: all });
    }

    /// The robot that is the target.
    fn target_among(&mut self, at: Times, stamp: RosTime, team: &TeamState, sink: &mut dyn Sink) {
        let seen = |robot: &&RobotState| {
            robot.name == self.settings.target_robot && robot.status == RobotState::STATUS_TRACKED
        };
        let Some(robot) = team.robots.iter().find(seen) else { return };
        let (sin, cos) = libm::sincos(robot.theta);
        let velocity = robot.v * Vector2::new(cos, sin);
        let turns = self.settings.target.turns;
        let carrier = Carrier::moving(Vector2::new(robot.x, robot.y), robot.theta, velocity, robot.omega, turns);
        let heard = self.target.believe(at, stamp, carrier);
        self.judge_target(heard, sink);
    }

    pub(crate) fn judge_target(&mut self, heard: Result<(), TargetRefusal>, sink: &mut dyn Sink) {
        let Err(refusal) = heard else {
            self.health.set("target", Condition::Ok, "followed");
            return;
        };
        if self.targets_refused == 0 {
            sink.log(Level::Warn, &refusal.to_string());
        }
        self.targets_refused += 1;
        self.health.set("target", Condition::Error, refusal.to_string());
        self.health.value("target", "refused", self.targets_refused);
    }

    /// The goals at `stamp`; none before there is an assignment, or while the frame of the formation is not heard of.
    fn goals(&self, at: Times, stamp: RosTime) -> Option<Goals> {
        let (assignment, team) = (self.assignment.as_ref()?, self.team.as_ref()?);
        let carrier = self.carrier(at.steady, stamp)?;
        let (plan, elapsed) = (&self.held.plan, self.elapsed(stamp));
        let goal = |seat: &Seated| {
            let queue = &plan.queues[seat.queue];
            let robot = team.robots.iter().find(|robot| robot.name == seat.robot)?;
            let here = carrier.from_map(Vector2::new(robot.x, robot.y));
            let point = virtual_point(&queue.curve, queue.places[seat.place], plan.motion, elapsed, here);
            let point = point.carried(&carrier);
            Some(Goal {
                robot: seat.robot.clone(),
                phase: point.phase,
                position: to_message(point.motion.position),
                velocity: to_message(point.motion.velocity),
                acceleration: to_message(point.motion.acceleration),
                remaining: point.remaining,
            })
        };
        let mut goals: Vec<Goal> = self.seats.iter().filter_map(goal).collect();
        goals.sort_by(|a, b| a.robot.cmp(&b.robot));
        let header = Header { stamp: stamp.into(), frame_id: MAP.to_owned() };
        Some(Goals { header, epoch: assignment.epoch, frame: carrier.message(), goals })
    }

    fn carrier(&self, now: Steady, stamp: RosTime) -> Option<Carrier> {
        match self.held.plan.frame {
            Frame::Map => Some(Carrier::MAP),
            Frame::Target => self.target.at(now, stamp),
        }
    }
}
