//! One tick: from the newest team state to a command.

use crate::dynamic::Reference;
use crate::face::Face;
use crate::hold::Hold;
use crate::inputs::Inputs;
use crate::monitor::{Monitor, News, Recursion, Watched};
use crate::robot::DEVIATION;
use crate::settings::Settings;
use crate::team_link::TeamLink;
use crate::{Deviation, Following, Predictor};
use trench_core::{RosTime, Steady, Times};
use trench_formation::Vector2;
use trench_formation::agent::Agent;
use trench_formation::kinematics::{Pose, Twist, Wheels};
use trench_formation::laws::Lyapunov;
use trench_formation::safety::Side;
use trench_formation::stability::Balanced;
use trench_formation::trench::AnyTrench;
use trench_formation::zoning::Zone;
use trench_msgs::msg::{Goal, RobotState, RunState};
use trench_msgs::visualization_msgs::MarkerArray;

/// A command that takes longer to the wheels than this was measured wrongly, s.
const LONGEST_COMMAND: f64 = 0.1;

/// What a law wants, and what it says of itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wanted {
    pub(crate) twist: Twist,
    /// Whether it wants the robot to rest.
    pub(crate) rests: bool,
    /// The point that it drives to, m; none while nothing draws the robot.
    pub(crate) drawn: Option<Vector2<f64>>,
    /// Where it means to stand, m, frame of the formation; none where it has chosen nothing.
    pub(crate) place: Option<Vector2<f64>>,
    /// |e_j| and M_j of chapter 8; none but under the queue law.
    pub(crate) error: Option<(f64, f64)>,
    /// From there, m.
    pub(crate) distance: f64,
    pub(crate) lyapunov: Lyapunov,
    /// m/s^2, map.
    pub(crate) acceleration: Vector2<f64>,
    /// What the safety filter leads round things to.
    pub(crate) detour: Option<Vector2<f64>>,
    /// How fast the law drives at this distance where nothing is in the way, m/s: what it integrates knows of no way round.
    pub(crate) pace: f64,
    /// What the monitor looks at; none while no law drives.
    pub(crate) watched: Option<Watched>,
    /// Where the leader is, and how far.
    pub(crate) zone: Option<(Zone, f64)>,
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
    /// Whether the robot moves otherwise than it is told.
    pub(crate) strays: bool,
    pub(crate) pose: Option<Pose>,
    pub(crate) wanted: Option<Wanted>,
    /// What the monitor makes of it.
    pub(crate) balanced: Option<Balanced>,
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
    pub(crate) deviation: Deviation,
    pub(crate) following: Following,
    pub(crate) holding: bool,
    pub(crate) last: Option<(RosTime, Wheels)>,
    /// What a dynamic law remembers; none under a kinematic one.
    pub(crate) agent: Option<Agent<AnyTrench>>,
    /// m, of the last tick that knew it: what a robot that rests says of itself.
    pub(crate) distance: Option<f64>,
    /// The side of the last way round, and when it was taken last.
    pub(crate) detour: Option<(Side, Steady)>,
    /// Where the law goes on.
    pub(crate) reference: Option<Reference>,
    pub(crate) face: Face,
    /// Whether the formation has moved since this process drives.
    pub(crate) formation_moved: bool,
    pub(crate) monitor: Monitor,
    /// M_j of (8.26).
    pub(crate) recursion: Recursion,
    /// What was expected at the last tick.
    pub(crate) news: Option<News>,
    /// When to draw, and what was drawn.
    pub(crate) draws: bool,
    pub(crate) picture: Option<MarkerArray>,
    /// Why gains that the operator allowed are refused otherwise.
    pub(crate) unstable_gains: Option<String>,
}

impl Tick {
    pub(crate) fn new(settings: Settings) -> Self {
        let (speed, turn, patience) = DEVIATION;
        let agent = settings.dynamic.as_ref().map(|dynamic| Agent::new(dynamic.agent.clone()));
        Self {
            monitor: Monitor::new(settings.monitor),
            recursion: Recursion::default(),
            news: None,
            unstable_gains: None,
            draws: false,
            picture: None,
            settings,
            inputs: Inputs::default(),
            predictor: Predictor::default(),
            team_link: TeamLink::default(),
            deviation: Deviation::new(speed, turn, patience),
            following: Following::default(),
            holding: false,
            last: None,
            agent,
            distance: None,
            detour: None,
            reference: None,
            face: Face::default(),
            formation_moved: false,
        }
    }

    /// Goes on under other settings.
    pub(crate) fn set(&mut self, settings: Settings) {
        self.agent = match (self.agent.take(), &settings.dynamic) {
            (Some(mut agent), Some(dynamic)) => {
                agent.set(dynamic.agent.clone());
                Some(agent)
            }
            (None, Some(dynamic)) => Some(Agent::new(dynamic.agent.clone())),
            (_, None) => None,
        };
        self.monitor = Monitor::new(settings.monitor);
        self.recursion.restart();
        self.settings = settings;
    }

    /// The robot has another place, or its segment is another one.
    pub(crate) fn renew(&mut self) {
        self.face = Face::default();
        if let Some(agent) = &mut self.agent {
            agent.renew();
        }
    }

    /// The command of this moment.
    pub(crate) fn run(&mut self, at: Times) -> Command {
        let mut command = self.rest(at);
        let acts = at.ros.plus_seconds(self.command_delay(at, command.exposure));
        match self.drive(at, acts, &mut command) {
            Ok(()) => {}
            Err(hold) => {
                // Who waits for its leader may have lost its team; who rests for another reason is not looking for it.
                if !matches!(hold, Hold::NoLeader(_)) {
                    self.team_link.rest();
                }
                let turn = if matches!(hold, Hold::NotSeen(_)) { self.identifying(at) } else { None };
                command.twist = turn.map_or(Twist::ZERO, |turn| self.followable(turn, acts, &mut command));
                command.hold = Some(hold);
                (self.holding, self.reference, self.news, self.face) = (false, None, None, Face::default());
                self.following.restart();
                self.monitor.restart();
                self.recursion.restart();
                if let Some(agent) = &mut self.agent {
                    agent.pause();
                }
            }
        }
        let wheels = self.reached(self.settings.axle.wheels(command.twist), acts);
        self.last = Some((acts, wheels));
        self.predictor.sent(acts, self.settings.axle.twist(wheels));
        command
    }

    /// From now to the wheels obeying, s: what the localizer has measured from the exposure on, or what the settings say.
    fn command_delay(&self, at: Times, exposure: RosTime) -> f64 {
        let measured = self.inputs.loop_delay.filter(|delay| self.settings.use_measured_delay && delay.is_finite());
        match measured.map(|delay| delay - at.ros.seconds_since(exposure)) {
            Some(left) if (0.0..LONGEST_COMMAND).contains(&left) => left,
            _ => self.settings.command_delay,
        }
    }

    /// A command to rest, with what is known of the robot.
    pub(crate) fn rest(&self, at: Times) -> Command {
        let exposure = self.inputs.team.as_ref().map(|team| RosTime::from(&team.message.header.stamp));
        Command {
            exposure: exposure.unwrap_or(at.ros),
            twist: Twist::ZERO,
            limits: 0,
            hold: None,
            strays: false,
            pose: self.inputs.robot(&self.settings.robot).map(pose_of),
            wanted: None,
            balanced: None,
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
        if self.inputs.voices.are_several(&self.settings.robot, at.steady) {
            return Err(Hold::TwoControllers);
        }
        if self.inputs.run.as_ref().is_none_or(|run| run.state != RunState::RUNNING) {
            return Err(Hold::NotRunning);
        }
        // Goals lead robots by their frame as well as by their points: who has none that are young rests, lost or not.
        if !self.inputs.goals.are_young(at, self.settings.goal_age_limit) {
            return Err(Hold::NoGoal);
        }
        let ahead = self.predictor.predict(pose_of(&state), command.exposure, acts);
        let recovery = self.recovery(at, acts, ahead);
        command.lost = recovery.is_some();
        let assigned = || self.inputs.goals.of(&self.settings.robot, acts);
        let goal = recovery.map(|point| (point, Goal::PHASE_APPROACH)).or_else(assigned).ok_or(Hold::NoGoal)?;
        let mut wanted = match self.settings.dynamic.clone() {
            None => self.track(ahead, goal),
            Some(dynamic) => self.steer(&dynamic, (at, acts), ahead, goal.0, command)?,
        };
        let faces = self.face((at, acts), ahead, &wanted);
        if let Some(turn) = faces {
            // What is driven is not the law: there is no way round for it, and nothing of it to watch.
            wanted = Wanted { twist: turn, detour: None, watched: None, ..wanted };
        }
        command.wanted = Some(wanted);
        self.distance = Some(wanted.distance);
        if !wanted.twist.is_finite() {
            return Err(Hold::NotFinite);
        }
        let followable = self.followable(wanted.twist, acts, command);
        let filtered = self.safe((at, acts), &state, followable, (wanted.detour, wanted.pace), command)?;
        if !filtered.is_finite() {
            return Err(Hold::NotFinite);
        }
        command.twist = if filtered == followable { filtered } else { self.within_reach(filtered, acts, command) };
        if faces.is_none() {
            self.follow_limits(at.steady, ahead, wanted.twist, command.twist);
        }
        if command.limits != 0 {
            self.recursion.restart();
        }
        self.watch(at, ahead, &wanted, command);
        Ok(())
    }
}

/// The pose of a team state's robot.
pub(crate) fn pose_of(state: &RobotState) -> Pose {
    Pose::new(state.x, state.y, state.theta)
}
