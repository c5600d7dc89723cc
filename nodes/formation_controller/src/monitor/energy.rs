//! What the inputs bring into the Lyapunov function of a dynamic law.

use super::{Function, Watched};
use crate::dynamic::DynamicSettings;
use crate::inputs::Ahead;
use nalgebra::Isometry2;
use trench_core::RosTime;
use trench_formation::Vector2;
use trench_formation::agent::{Driven, Surroundings};
use trench_formation::kinematics::{PointState, Pose, Twist};
use trench_formation::laws::{GoalMotion, RigidMotion};
use trench_formation::stability::{Input, Supply};

/// What the law expects the robot to do up to the next tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Expected {
    /// To follow this twist for so long, s.
    Twist(Twist, f64),
    /// That the steered point moves with `mean` for `duration`, and has the velocity `end` then; its reference moves with `still`.
    Point { mean: Vector2<f64>, end: Vector2<f64>, still: Vector2<f64>, duration: f64 },
}

impl Expected {
    /// What it brings into V, with the gradient by position and heading, that the robot at `pose` follows `sent` instead.
    pub(crate) fn missed(&self, gradient: (Vector2<f64>, f64), pose: Pose, sent: Twist, point: Vector2<f64>) -> f64 {
        let (along, turning) = gradient;
        match *self {
            Self::Twist(wanted, duration) => {
                let (v, omega) = (sent.v - wanted.v, sent.omega - wanted.omega);
                duration * (v * along.dot(&pose.heading()) + omega * turning)
            }
            Self::Point { mean, end, still, duration } => {
                let kinetic = |velocity: Vector2<f64>| 0.5 * (velocity - still).norm_squared();
                duration * along.dot(&(point - mean)) + kinetic(point) - kinetic(end)
            }
        }
    }
}

/// What a robot expected of its surroundings, to tell news from what was known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct News {
    at: RosTime,
    map_from_segment: Isometry2<f64>,
    motion: RigidMotion,
    goal: Option<GoalMotion>,
    leader: Option<Ahead>,
    drawn: Option<Vector2<f64>>,
    robot: Vector2<f64>,
    sliding: f64,
}

impl News {
    fn of(tick: &Driving<'_>, still: Vector2<f64>) -> Self {
        let (around, driven) = (tick.around, tick.driven);
        Self {
            at: tick.acts,
            map_from_segment: around.map_from_segment,
            motion: around.motion,
            goal: around.goal,
            leader: tick.leader,
            drawn: driven.first.attraction,
            robot: tick.robot.position,
            sliding: (driven.end.velocity - still).norm(),
        }
    }

    /// What has come otherwise at `now`, where this was expected, in units of V; and whether the point that draws the robot jumped by
    /// more than `margin` (m).
    fn compared(&self, now: &Self, driven: &Driven, robot: Vector2<f64>, margin: f64) -> (Supply, bool) {
        let mut supply = Supply::default();
        let elapsed = now.at.seconds_since(self.at);
        let forces = driven.first.forces;
        let (pose, motion) = self.motion.carried(self.map_from_segment, elapsed);
        let moved = now.map_from_segment * pose.inverse_transform_point(&robot.into());
        let (mut by, mut faster) =
            ((moved.coords - robot).norm(), (now.motion.at(robot).velocity - motion.at(robot).velocity).norm());
        if let (Some(before), Some(goal)) = (self.goal, now.goal) {
            let expected = before.after(elapsed);
            by = (goal.position - expected.position).norm();
            faster = (goal.velocity - expected.velocity).norm();
        }
        let turning = elapsed * now.motion.turn_rate.abs() * self.sliding * self.sliding;
        supply.add(Input::Frame, forces.trench.norm() * by + (self.sliding + 0.5 * faster) * faster + turning);
        if let (Some(before), Some(leader)) = (self.leader, now.leader) {
            let expected = before.leader.state.coasted(elapsed).position;
            supply.add(Input::Leader, forces.zoning.norm() * (leader.leader.state.position - expected).norm());
        }
        let mut jumped = false;
        if let (Some(before), Some(drawn), None) = (self.drawn, now.drawn, now.goal) {
            let carried = |point: Vector2<f64>| {
                (now.map_from_segment * self.map_from_segment.inverse_transform_point(&point.into())).coords
            };
            // A nearest point slides along with its robot; by more than that the ends of fragments move it.
            let slid = (drawn - carried(before)).norm() - 1.5 * (robot - carried(self.robot)).norm();
            jumped = slid > margin;
            supply.add(Input::Robots, forces.trench.norm() * slid);
        }
        (supply, jumped)
    }
}

/// A tick of a dynamic law.
pub(crate) struct Driving<'a> {
    pub(crate) settings: &'a DynamicSettings,
    pub(crate) around: &'a Surroundings<'a>,
    pub(crate) leader: Option<Ahead>,
    pub(crate) driven: &'a Driven,
    pub(crate) robot: PointState,
    pub(crate) acts: RosTime,
    /// s
    pub(crate) duration: f64,
    pub(crate) epoch: u64,
}

impl Driving<'_> {
    /// What the monitor looks at; `before` is what was expected at the last tick, and afterwards at this.
    pub(crate) fn watched(&self, before: &mut Option<News>) -> Watched {
        let Driven { end, mean_velocity, first, .. } = self.driven;
        let (around, position) = (self.around, self.robot.position);
        let still = around.goal.map_or_else(|| around.motion.at(position).velocity, |goal| goal.velocity);
        let expected = News::of(self, still);
        // A nearest point that goes by this much is another one.
        let margin = self.settings.agent.seeking.transit_margin;
        let (news, jumped) = before
            .replace(expected)
            .map_or_else(Default::default, |before| before.compared(&expected, self.driven, position, margin));
        Watched {
            function: Function {
                law: Some(self.settings.law),
                epoch: self.epoch,
                draws: first.attraction.is_some(),
                remedy: first.remedy,
                goal: (0, false),
            },
            value: first.steered.lyapunov,
            rate: first.steered.lyapunov_rate + first.cut_power,
            gradient: (-first.forces.of_potentials(), 0.0),
            news,
            supply: supplied(self.driven, self.leader, self.settings.capability.speed, self.duration),
            expected: Expected::Point { mean: *mean_velocity, end: end.velocity, still, duration: self.duration },
            jumped,
        }
    }
}

/// What the inputs bring in up to the next tick. The leader's part is the recursion of chapter 8: its speed in the segment's frame is
/// within sqrt(2 V) of its own Lyapunov function, and within `speed` (m/s).
fn supplied(driven: &Driven, leader: Option<Ahead>, speed: f64, duration: f64) -> Supply {
    let mut supply = Supply::default();
    supply.add(Input::Law, driven.work.law);
    let admitted = leader.map_or(0.0, |leader| (2.0 * leader.lyapunov.max(0.0)).sqrt().min(speed));
    let most = duration * driven.first.forces.zoning.norm() * admitted;
    supply.add(Input::Leader, driven.work.leader.max(most));
    supply.add(Input::Robots, driven.work.robots);
    supply.add(Input::Obstacles, driven.work.obstacles);
    supply.add(Input::Limits, driven.work.limits);
    supply
}
