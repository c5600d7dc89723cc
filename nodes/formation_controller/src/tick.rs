//! One tick: from the newest team state to a command.

use crate::dynamic::Agent;
use crate::hold::Hold;
use crate::inputs::Inputs;
use crate::settings::Settings;
use crate::team_link::TeamLink;
use crate::{Deviation, Predictor};
use trench_core::{RosTime, Steady, Times};
use trench_formation::Vector2;
use trench_formation::kinematics::{Limited, Pose, Twist, Wheels, saturate};
use trench_formation::laws::{GoalMotion, Lyapunov};
use trench_formation::safety::Side;
use trench_msgs::msg::{Goal, LeaderState, RobotState, RunState};

/// Speeds by which a robot may miss its command before it counts as deviating, and for how long (invariant 8).
const DEVIATION: (f64, f64, f64) = (0.08, 2.5, 0.3);

/// A stamp may be this far ahead of our clock, s: more is a pose from the future, which nobody has.
pub(crate) const CLOCK_ERROR: f64 = 0.005;

/// What a law wants, and what it says of itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wanted {
    pub(crate) twist: Twist,
    /// The point that it drives to, m; none while nothing draws the robot.
    pub(crate) drawn: Option<Vector2<f64>>,
    /// From there, m.
    pub(crate) distance: f64,
    pub(crate) lyapunov: Lyapunov,
    /// m/s^2, map.
    pub(crate) acceleration: Vector2<f64>,
    /// What the safety filter leads round things to.
    pub(crate) detour: Option<Vector2<f64>>,
}

/// What a tick decides.
#[derive(Debug, Clone)]
pub(crate) struct Command {
    /// Exposure of the team state it rests on: commands of one frame have equal stamps.
    pub(crate) exposure: RosTime,
    pub(crate) twist: Twist,
    /// `LeaderState::LIMIT_*` bits.
    pub(crate) limits: u8,
    pub(crate) hold: Option<Hold>,
    pub(crate) pose: Option<Pose>,
    pub(crate) wanted: Option<Wanted>,
    /// Whether the robot is looking for its team (Remark 6.2.1).
    pub(crate) lost: bool,
    /// How far the leader is where that is beyond rho_bar, m.
    pub(crate) beyond_reach: Option<f64>,
}

/// The state of a controller between ticks.
pub(crate) struct Tick {
    pub(crate) settings: Settings,
    pub(crate) inputs: Inputs,
    pub(crate) predictor: Predictor,
    pub(crate) team_link: TeamLink,
    deviation: Deviation,
    holding: bool,
    last: Option<(RosTime, Wheels)>,
    pub(crate) agent: Agent,
    /// The side of the last way round, and when it was taken last.
    pub(crate) detour: Option<(Side, Steady)>,
    /// Velocity of the steered point at the end of the last tick, m/s: where the next one goes on.
    pub(crate) reference: Option<Vector2<f64>>,
}

impl Tick {
    pub(crate) fn new(settings: Settings) -> Self {
        let (speed, turn, patience) = DEVIATION;
        Self {
            settings,
            inputs: Inputs::default(),
            predictor: Predictor::default(),
            team_link: TeamLink::default(),
            deviation: Deviation::new(speed, turn, patience),
            holding: false,
            last: None,
            agent: Agent::default(),
            detour: None,
            reference: None,
        }
    }

    /// The command of this moment.
    pub(crate) fn run(&mut self, at: Times) -> Command {
        let acts = at.ros.plus_seconds(self.settings.command_delay);
        let mut command = self.rest(at);
        match self.drive(at, acts, &mut command) {
            Ok(()) => {}
            Err(hold) => {
                // Who waits for its leader may have lost its team; who rests for another reason is not looking for it.
                if !matches!(hold, Hold::NoLeader(_)) {
                    self.team_link.rest();
                }
                (command.twist, command.hold) = (Twist::ZERO, Some(hold));
                (self.holding, self.reference) = (false, None);
            }
        }
        self.last = Some((acts, self.settings.axle.wheels(command.twist)));
        self.predictor.sent(acts, command.twist);
        command
    }

    /// A command to rest, with what is known of the robot.
    pub(crate) fn rest(&self, at: Times) -> Command {
        let exposure = self.inputs.team.as_ref().map(|team| RosTime::from(&team.message.header.stamp));
        Command {
            exposure: exposure.unwrap_or(at.ros),
            twist: Twist::ZERO,
            limits: 0,
            hold: None,
            pose: self.inputs.robot(&self.settings.robot).map(pose_of),
            wanted: None,
            lost: false,
            beyond_reach: None,
        }
    }

    fn drive(&mut self, at: Times, acts: RosTime, command: &mut Command) -> Result<(), Hold> {
        let state = self.usable_state(at, command)?.clone();
        self.deviates(command.exposure, &state, command);
        if self.inputs.emergency_stop {
            return Err(Hold::EmergencyStop);
        }
        if self.inputs.run.as_ref().is_none_or(|run| run.state != RunState::RUNNING) {
            return Err(Hold::NotRunning);
        }
        let ahead = self.predictor.predict(pose_of(&state), command.exposure, acts);
        let recovery = self.recovery(at, acts, ahead);
        command.lost = recovery.is_some();
        let assigned = || self.inputs.goal(&self.settings.robot, acts, at.steady, self.settings.goal_age_limit);
        let goal = recovery.map(|point| (point, Goal::PHASE_APPROACH)).or_else(assigned).ok_or(Hold::NoGoal)?;
        let wanted = match self.settings.dynamic.clone() {
            None => self.track(ahead, goal),
            Some(dynamic) => self.steer(&dynamic, (at, acts), ahead, goal.0, command)?,
        };
        command.wanted = Some(wanted);
        if !wanted.twist.is_finite() {
            return Err(Hold::NotFinite);
        }
        let followable = self.followable(wanted.twist, acts, command);
        command.twist = self.safe(at, &state, followable, wanted.detour, command)?;
        if !command.twist.is_finite() {
            return Err(Hold::NotFinite);
        }
        self.follow_limits(ahead, wanted.twist, command.twist);
        Ok(())
    }

    /// A kinematic law of chapter 4.
    fn track(&mut self, ahead: Pose, (goal, phase): (GoalMotion, u8)) -> Wanted {
        let tracked = self.settings.law.track(self.settings.dead_band, ahead, goal, self.holding);
        self.holding = tracked.holding;
        Wanted {
            twist: tracked.twist,
            drawn: Some(goal.position),
            distance: tracked.distance,
            lyapunov: tracked.lyapunov,
            acceleration: Vector2::zeros(),
            // A goal that moves on is no place that a robot could be in the way of.
            detour: (phase != Goal::PHASE_MOVING || !self.holding).then_some(goal.position),
        }
    }

    /// The robot's state, if it is one to drive by.
    fn usable_state(&self, at: Times, command: &mut Command) -> Result<&RobotState, Hold> {
        let state = self.inputs.robot(&self.settings.robot).ok_or(Hold::NoTeamState)?;
        if !matches!(state.status, RobotState::STATUS_TRACKED | RobotState::STATUS_PREDICTED) {
            return Err(Hold::NotSeen(state.status));
        }
        // Both clocks: the stamp tells how old the pose was on arrival, the monotonic clock how long it has lain here.
        let lain = self.inputs.team.as_ref().map_or(f64::INFINITY, |team| at.steady.seconds_since(team.at));
        let stamped = at.ros.seconds_since(command.exposure);
        let unseen = unseen(state);
        if stamped.max(lain) + unseen > self.settings.information_age_limit {
            command.limits |= LeaderState::LIMIT_STALE;
            return Err(Hold::OldPose(stamped.max(lain) + unseen));
        }
        if stamped.max(lain) > self.settings.pose_age_limit || stamped < -CLOCK_ERROR {
            command.limits |= LeaderState::LIMIT_STALE;
            return Err(Hold::OldPose(stamped));
        }
        Ok(state)
    }

    fn deviates(&mut self, exposure: RosTime, state: &RobotState, command: &mut Command) {
        let seen = Twist { v: state.v, omega: state.omega };
        // The localizer's velocity lags by a few frames: anything the robot was told lately explains it.
        let commands = [self.predictor.in_force(exposure.plus_seconds(-0.15)), self.predictor.in_force(exposure)];
        if self.deviation.observe(exposure, seen, commands) {
            command.limits |= LeaderState::LIMIT_DEVIATES;
        }
    }

    /// The twist nearest to the law's that the wheels can follow from what they were told last.
    fn followable(&self, twist: Twist, acts: RosTime, command: &mut Command) -> Twist {
        let wanted = saturate(self.settings.axle.wheels(twist), self.settings.max_wheel_speed);
        if wanted.acted {
            command.limits |= LeaderState::LIMIT_WHEELS;
        }
        let ramped = self.ramped(wanted.value, acts);
        if ramped.acted {
            command.limits |= LeaderState::LIMIT_RAMP;
        }
        self.settings.axle.twist(ramped.value)
    }

    fn ramped(&self, wanted: Wheels, acts: RosTime) -> Limited<Wheels> {
        let (before, current) = self.last.unwrap_or((acts, Wheels::default()));
        let interval = acts.seconds_since(before).clamp(0.0, 0.1);
        self.settings.ramp.limit(current, wanted, interval)
    }
}

/// Seconds since a robot was seen, at the exposure.
pub(crate) fn unseen(state: &RobotState) -> f64 {
    (f64::from(state.unseen.sec) + 1e-9 * f64::from(state.unseen.nanosec)).max(0.0)
}

/// The pose of a team state's robot.
pub(crate) fn pose_of(state: &RobotState) -> Pose {
    Pose::new(state.x, state.y, state.theta)
}
