//! One tick: from the newest team state to a command.

use crate::inputs::Inputs;
use crate::settings::Settings;
use crate::{Deviation, Predictor};
use std::fmt;
use trench_core::{Condition, RosTime, Times};
use trench_formation::Vector2;
use trench_formation::curve::Curve;
use trench_formation::hull::Outline;
use trench_formation::kinematics::{Pose, Twist, Wheels, saturate};
use trench_formation::laws::{GoalMotion, Tracked};
use trench_formation::safety::{MovingOutline, Neighbour, Scene, Wish};
use trench_msgs::msg::{Goal, LeaderState, Queue, RobotState, RunState};
use trench_plan::curve_from_message;

/// Speeds by which a robot may miss its command before it counts as deviating, and for how long (invariant 8).
const DEVIATION: (f64, f64, f64) = (0.08, 2.5, 0.3);

/// A stamp may be this far ahead of our clock, s: more is a pose from the future, which nobody has.
const CLOCK_ERROR: f64 = 0.005;

/// Why the robot is told to rest.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Hold {
    NotRunning,
    EmergencyStop,
    NoTeamState,
    NotSeen(u8),
    OldPose(f64),
    NoGoal,
    NoMapper,
    NotFinite,
}

impl Hold {
    pub(crate) fn condition(&self) -> Condition {
        match self {
            Self::NotRunning => Condition::Ok,
            Self::NoTeamState | Self::OldPose(_) | Self::NoGoal => Condition::Stale,
            Self::EmergencyStop | Self::NotSeen(_) | Self::NoMapper | Self::NotFinite => Condition::Error,
        }
    }
}

impl fmt::Display for Hold {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotRunning => write!(formatter, "resting: the run is not running"),
            Self::EmergencyStop => write!(formatter, "resting: emergency stop"),
            Self::NoTeamState => write!(formatter, "resting: no team state with this robot was heard"),
            Self::NotSeen(RobotState::STATUS_AMBIGUOUS) => write!(formatter, "resting: which robot it is, is in doubt"),
            Self::NotSeen(_) => write!(formatter, "resting: the localizer has lost the robot"),
            Self::OldPose(age) => write!(formatter, "resting: the pose is {age:.3} s old"),
            Self::NoGoal => write!(formatter, "resting: no goal is heard"),
            Self::NoMapper => write!(formatter, "resting: no obstacle mapper is heard"),
            Self::NotFinite => write!(formatter, "resting: the law gave a number that is not finite"),
        }
    }
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
    pub(crate) goal: Option<GoalMotion>,
    pub(crate) tracked: Option<Tracked>,
}

/// The curves of a formation, made once, with their tolerances (m); none for a segment that is no curve.
struct Segments {
    formation_hash: u64,
    queues: Vec<(Option<Curve>, f64)>,
}

/// The state of a controller between ticks.
pub(crate) struct Tick {
    pub(crate) settings: Settings,
    pub(crate) inputs: Inputs,
    predictor: Predictor,
    deviation: Deviation,
    holding: bool,
    last: Option<(RosTime, Wheels)>,
    segments: Option<Segments>,
}

impl Tick {
    pub(crate) fn new(settings: Settings) -> Self {
        let (speed, turn, patience) = DEVIATION;
        Self {
            settings,
            inputs: Inputs::default(),
            predictor: Predictor::default(),
            deviation: Deviation::new(speed, turn, patience),
            holding: false,
            last: None,
            segments: None,
        }
    }

    /// The command of this moment.
    pub(crate) fn run(&mut self, at: Times) -> Command {
        let acts = at.ros.plus_seconds(self.settings.command_delay);
        let mut command = self.rest(at);
        match self.drive(at, acts, &mut command) {
            Ok(()) => {}
            Err(hold) => {
                (command.twist, command.hold) = (Twist::ZERO, Some(hold));
                self.holding = false;
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
            goal: None,
            tracked: None,
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
        let goal_age_limit = self.settings.goal_age_limit;
        let goal = self.inputs.goal(&self.settings.robot, acts, at.steady, goal_age_limit);
        let (goal, phase) = goal.ok_or(Hold::NoGoal)?;
        let ahead = self.predictor.predict(pose_of(&state), command.exposure, acts);
        let tracked = self.settings.law.track(self.settings.dead_band, ahead, goal, self.holding);
        self.holding = tracked.holding;
        (command.goal, command.tracked) = (Some(goal), Some(tracked));
        if !tracked.twist.is_finite() {
            return Err(Hold::NotFinite);
        }
        let followable = self.followable(tracked.twist, acts, command);
        command.twist = self.safe(at, &state, followable, goal, phase, command)?;
        if !command.twist.is_finite() {
            return Err(Hold::NotFinite);
        }
        Ok(())
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

    fn ramped(&self, wanted: Wheels, acts: RosTime) -> trench_formation::kinematics::Limited<Wheels> {
        let (before, current) = self.last.unwrap_or((acts, Wheels::default()));
        let interval = acts.seconds_since(before).clamp(0.0, 0.1);
        self.settings.ramp.limit(current, wanted, interval)
    }

    fn safe(
        &self,
        at: Times,
        state: &RobotState,
        twist: Twist,
        goal: GoalMotion,
        phase: u8,
        command: &mut Command,
    ) -> Result<Twist, Hold> {
        if !self.settings.safety_enabled {
            return Ok(twist);
        }
        let obstacles = self.inputs.obstacles.as_ref();
        let fresh =
            obstacles.is_some_and(|heard| at.steady.seconds_since(heard.at) <= self.settings.obstacle_age_limit);
        if self.settings.needs_mapper && !fresh {
            command.limits |= LeaderState::LIMIT_STALE;
            return Err(Hold::NoMapper);
        }
        let neighbours = self.neighbours(at);
        let hulls = self.inputs.hulls();
        let obstacles: Vec<MovingOutline<'_>> = hulls
            .iter()
            .map(|hull| MovingOutline {
                outline: Outline { points: &hull.points, radius: hull.radius },
                velocity: hull.velocity,
            })
            .collect();
        let scene = Scene { neighbours: &neighbours, obstacles: &obstacles, field: &self.settings.field };
        // A goal that moves on is no place that a robot could be in the way of.
        let goal = (phase != Goal::PHASE_MOVING || !self.holding).then_some(goal.position);
        let now = Twist { v: state.v, omega: state.omega };
        let filtered = self.settings.safety.apply(pose_of(state), now, Wish { twist, goal }, &scene);
        if filtered.acted.is_some() {
            command.limits |= LeaderState::LIMIT_SAFETY;
        }
        Ok(filtered.twist)
    }

    /// The other robots as the vision sees them, and what they say of themselves.
    fn neighbours(&self, at: Times) -> Vec<Neighbour> {
        let Some(team) = &self.inputs.team else { return Vec::new() };
        let others = team.message.robots.iter().filter(|other| other.name != self.settings.robot);
        let neighbour = |other: &RobotState| {
            let said = self.inputs.others.get(&other.name);
            let said = said
                .filter(|said| at.steady.seconds_since(said.at) <= self.settings.leader_state_age_limit)
                .map(|said| &said.message);
            let tracked = other.status == RobotState::STATUS_TRACKED;
            let obeys = said.is_some_and(|said| said.limited_by & LeaderState::LIMIT_DEVIATES == 0);
            let arrived = said.is_some_and(|said| said.goal_distance < 2.0 * self.settings.dead_band.resume);
            let (sin, cos) = libm::sincos(other.theta);
            Neighbour {
                position: Vector2::new(other.x, other.y),
                velocity: other.v * Vector2::new(cos, sin),
                radius: self.settings.body_radius,
                cooperative: tracked && obeys,
                settled: arrived && other.v.abs() < 0.01,
            }
        };
        others.map(neighbour).collect()
    }

    /// Distance of `position` from the segment of queue `queue`, and the queue's tolerance, both in metres. Formations
    /// that move with the target are measured where their goal is, not here.
    pub(crate) fn segment_distance(&mut self, position: Vector2<f64>, queue: u32) -> Option<(f64, f64)> {
        let formation = self.inputs.formation.as_ref().filter(|formation| formation.header.frame_id == "map")?;
        if self.segments.as_ref().is_none_or(|known| known.formation_hash != formation.hash) {
            let curve = |queue: &Queue| (curve_from_message(&queue.segment).ok(), queue.tolerance);
            let queues = formation.queues.iter().map(curve).collect();
            self.segments = Some(Segments { formation_hash: formation.hash, queues });
        }
        let (curve, tolerance) = self.segments.as_ref()?.queues.get(queue as usize)?;
        Some((curve.as_ref()?.nearest(position).distance, *tolerance))
    }
}

fn pose_of(state: &RobotState) -> Pose {
    Pose::new(state.x, state.y, state.theta)
}
