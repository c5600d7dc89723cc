//! What came otherwise than was expected from one tick to the next.
//!
//! V of A.18 is a function of the robot's state x and of all that is around it, S: V(x, S). Where tick k saw x_k and S_k, and S_k(t) is S_k
//! carried on by the velocities that the law went by, the change of V up to the next tick is, without any approximation,
//!
//! V(x', S') - V(x_k, S_k) = [V(x', S') - V(x', S_k(t))] + [V(x', S_k(t)) - V(s, S_k(t))] + [V(s, S_k(t)) - V(e, S_k(d))] + [V(e, S_k(d)) - V(x_k, S_k)]
//!
//! with e where the law is after the d seconds that it was integrated for, s where what was sent leads to within t. The last bracket is the
//! law's own work and that of what moves as it was seen to (`Driven::work`: A.18's V' with the velocities of leader, robots and obstacles);
//! the third is what limits, the filter and a late tick do; the first is what leader, robots ahead, obstacles, frame and fragments did
//! otherwise. The second is what the robot does otherwise than it is told: no input, and within the tolerances or a violation.

use nalgebra::Isometry2;
use trench_core::RosTime;
use trench_formation::Vector2;
use trench_formation::agent::{Action, Agent, Driven, Leader, Surroundings};
use trench_formation::curve::Curve;
use trench_formation::hull::ApparentObstacle;
use trench_formation::kinematics::{PointState, Pose, Twist};
use trench_formation::laws::{GoalMotion, RigidMotion};
use trench_formation::stability::{Input, Supply};
use trench_formation::trench::{AnyTrench, Trench};

/// A tick that comes so much earlier or later than was expected comes in time, s: half a step of the law's integration.
const IN_TIME: f64 = 5e-4;

/// All that was around a robot at a tick, and what it was told.
#[derive(Debug, Clone)]
pub(crate) struct News {
    at: RosTime,
    map_from_segment: Isometry2<f64>,
    motion: RigidMotion,
    goal: Option<GoalMotion>,
    leader: Option<Leader>,
    ahead: Vec<PointState>,
    places: Vec<Vector2<f64>>,
    behind: usize,
    apparent: Vec<ApparentObstacle>,
    velocities: Vec<Vector2<f64>>,
    robot: Vector2<f64>,
    end: PointState,
    /// s
    duration: f64,
    told: Told,
    /// m/s, relative to what draws the robot.
    sliding: f64,
}

/// How the steered point moves until it is told something else.
#[derive(Debug, Clone, Copy)]
enum Told {
    /// As the law wants it, m/s.
    Wanted(Vector2<f64>),
    /// By a twist from a pose, the point `look_ahead` (m) before the axle; changed by this.
    Sent(Pose, Twist, f64, Input),
}

impl News {
    pub(super) fn of(
        around: &Surroundings<'_>,
        driven: &Driven,
        robot: PointState,
        (at, duration): (RosTime, f64),
    ) -> Self {
        let still = around.goal.map_or_else(|| around.motion.at(robot.position).velocity, |goal| goal.velocity);
        Self {
            at,
            map_from_segment: around.map_from_segment,
            motion: around.motion,
            goal: around.goal,
            leader: around.leader,
            ahead: around.ahead.to_vec(),
            places: around.places.to_vec(),
            behind: around.behind,
            apparent: around.apparent.to_vec(),
            velocities: around.velocities.to_vec(),
            robot: robot.position,
            end: driven.end,
            duration,
            told: Told::Wanted(driven.mean_velocity),
            sliding: (driven.end.velocity - still).norm(),
        }
    }

    /// The robot is sent another twist than its law wants.
    pub(crate) fn sent(&mut self, pose: Pose, twist: Twist, look_ahead: f64, by: Input) {
        self.told = Told::Sent(pose, twist, look_ahead, by);
    }

    /// What has come otherwise for a robot that its law takes for `robot` at `now`, before `agent` looks around again.
    pub(crate) fn foreseen(
        &self,
        agent: &Agent<AnyTrench>,
        curve: &Curve,
        robot: PointState,
        now: RosTime,
    ) -> Foreseen {
        let elapsed = now.seconds_since(self.at);
        let around = self.around(curve);
        let value = |state: PointState, since: f64| agent.foreseen(&around, state, since).steered.lyapunov;
        let (led_to, by) = match self.told {
            // Where the law is.
            Told::Wanted(_) if (elapsed - self.duration).abs() <= IN_TIME => (None, Input::Limits),
            Told::Wanted(mean) => (Some(self.robot + elapsed * mean), Input::Limits),
            Told::Sent(pose, twist, look_ahead, by) => {
                let pose = pose.advanced(twist, elapsed);
                (Some(pose.position() + look_ahead * pose.heading()), by)
            }
        };
        let led = led_to.map_or(0.0, |position| {
            value(PointState { position, velocity: robot.velocity }, elapsed) - value(self.end, self.duration)
        });
        Foreseen { action: agent.foreseen(&around, robot, elapsed), led, by, elapsed }
    }

    fn around<'a>(&'a self, curve: &'a Curve) -> Surroundings<'a> {
        Surroundings {
            time: 0.0,
            curve,
            map_from_segment: self.map_from_segment,
            motion: self.motion,
            goal: self.goal,
            leader: self.leader,
            ahead: &self.ahead,
            places: &self.places,
            behind: self.behind,
            real: &[],
            apparent: &self.apparent,
            velocities: &self.velocities,
            clear: 0.0,
        }
    }

    /// What each input brought in that nobody expected, for a robot at `robot`, now that it is in `around` and does `action`.
    pub(crate) fn compared(
        &self,
        foreseen: &Foreseen,
        (around, action, robot): (&Surroundings<'_>, &Action, Vector2<f64>),
        trench: &AnyTrench,
    ) -> Supply {
        let Foreseen { action: before, led, by, elapsed } = foreseen;
        let mut supply = Supply::default();
        supply.add(*by, *led);
        let (then, now) = (before.values, action.values);
        supply.add(Input::Leader, now.leader - then.leader);
        supply.add(Input::Obstacles, now.obstacles - then.obstacles);
        // The attraction, and what moves with it.
        let own = |action: &Action| action.steered.lyapunov - action.values.sum();
        let (all, mut ends) = (own(action) - own(before), 0.0);
        if let (Some(expected), Some(drawn), None) = (before.attraction, action.attraction, around.goal) {
            // Where the point of the segment is that was expected to draw: elsewhere only fragments can have moved it.
            let (pose, _) = self.motion.carried(self.map_from_segment, *elapsed);
            let kept = (around.map_from_segment * pose.inverse_transform_point(&expected.into())).coords;
            ends = trench.value((drawn - robot).norm()) - trench.value((kept - robot).norm());
        }
        supply.add(Input::Robots, now.robots - then.robots + ends);
        let turning = elapsed * around.motion.turn_rate.abs() * self.sliding * self.sliding;
        supply.add(Input::Frame, all - ends + turning);
        supply
    }
}

/// What the surroundings of a tick would be at the next, had nothing come otherwise.
pub(crate) struct Foreseen {
    /// What the law would say.
    action: Action,
    /// What limits, the filter and a late tick brought in.
    led: f64,
    by: Input,
    /// s
    elapsed: f64,
}
