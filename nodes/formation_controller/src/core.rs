//! The node core: events in, ticks, messages out.

use crate::inputs::{Heard, Hull, point};
use crate::refusal::Refusal;
use crate::segments::Segments;
use crate::settings::{Settings, check_gains, descriptors};
use crate::tick::{Command, Tick, unseen};
use std::collections::BTreeMap;
use std::sync::Arc;
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Advertise, Condition, Event, Files, Health, Interface, Level, Local, Master, NodeContext, NodeCore,
    NodeDescription, NotMaster, Qos, Sink, Source, StartError, Steady, Subscribe, Times, resolve_name,
};
use trench_formation::Vector2;
use trench_msgs::Message;
use trench_msgs::cdr::CdrError;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::geometry_msgs::{Twist, TwistStamped};
use trench_msgs::msg::{
    ApparentObstacleArray, Assignment, Formation, Goals, LeaderState, LinkStatus, RunState, TeamState,
};
use trench_msgs::std_msgs::{Bool, Header};

const TEAM_STATE: usize = 0;
const GOALS: usize = 1;
const ASSIGNMENT: usize = 2;
const FORMATION: usize = 3;
const RUN_STATE: usize = 4;
const APPARENT_OBSTACLES: usize = 5;
const EMERGENCY_STOP: usize = 6;
const LINK: usize = 7;
/// Leader states of the others follow from here on.
const OTHERS: usize = 8;

const CMD_VEL: usize = 0;
const LEADER_STATE: usize = 1;
const DIAGNOSTICS: usize = 2;

/// Room for one small message in shared memory.
const SMALL: Local = Local::SharedMemory { max_len: 1024 };

/// Room for a leader state that names some hundred robots.
const STATE: Local = Local::SharedMemory { max_len: 8192 };

/// Why a message was dropped.
#[derive(Debug, thiserror::Error)]
enum Dropped {
    #[error(transparent)]
    Cdr(#[from] CdrError),
    #[error(transparent)]
    Refused(#[from] Refusal),
    #[error(transparent)]
    NotMaster(#[from] NotMaster),
}

/// One robot's controller.
pub struct FormationController {
    interface: Interface,
    tick: Tick,
    others: Vec<String>,
    /// Who writes the topics that come again and again, by port.
    masters: BTreeMap<usize, Master>,
    health: Health,
    wakeup: Option<Steady>,
    bad_messages: u64,
    /// Gains outside the stable zone that the operator allowed, to be told once the log is open.
    warning: Option<String>,
}

/// The node as processes and the simulator make it.
#[must_use]
pub fn description() -> NodeDescription {
    NodeDescription {
        name: "formation_controller",
        about: "Drives one robot to its place in the formation",
        parameters: descriptors,
        build,
    }
}

fn build(context: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let settings = Settings::read(parameters, &context.namespace)?;
    let warning = admit_gains(parameters)?;
    let others: Vec<String> = settings.team.iter().filter(|name| **name != settings.robot).cloned().collect();
    Ok(Box::new(FormationController {
        interface: interface(&settings, &others),
        health: Health::new(resolve_name("~", &context.namespace, &context.name)),
        tick: Tick::new(settings),
        others,
        masters: BTreeMap::new(),
        wakeup: None,
        bad_messages: 0,
        warning,
    }))
}

/// Refuses gains outside the stable zone, or gives the warning where the operator allows them.
fn admit_gains(parameters: &Parameters) -> Result<Option<String>, ConfigError> {
    match check_gains(parameters) {
        Err(refusal) if parameters.bool("refuse_unstable_gains")? => Err(refusal),
        Err(refusal) => Ok(Some(refusal.to_string())),
        Ok(()) => Ok(None),
    }
}

fn interface(settings: &Settings, others: &[String]) -> Interface {
    // Goals, obstacles and what the others say are used at the next tick, and wake nobody.
    let mut subscriptions = vec![
        Subscribe::to::<TeamState>("/team_state", Qos::RELIABLE),
        Subscribe::to::<Goals>("/goals", Qos::RELIABLE).without_waking(),
        Subscribe::to::<Assignment>("/assignment", Qos::LATCHED),
        Subscribe::to::<Formation>("/formation", Qos::LATCHED),
        Subscribe::to::<RunState>("/run_state", Qos::LATCHED),
        Subscribe::to::<ApparentObstacleArray>("/apparent_obstacles", Qos::RELIABLE).without_waking(),
        Subscribe::to::<Bool>("/emergency_stop", Qos::RELIABLE),
        Subscribe::to::<LinkStatus>(format!("/{}/link", settings.robot), Qos::RELIABLE).without_waking(),
    ];
    let leader_state =
        |name: &String| Subscribe::to::<LeaderState>(format!("/{name}/leader_state"), Qos::RELIABLE).without_waking();
    subscriptions.extend(others.iter().map(leader_state));
    let robot = &settings.robot;
    let command = format!("/{robot}/cmd_vel");
    let command = if settings.stamped {
        Advertise::of::<TwistStamped>(command, Qos::RELIABLE, SMALL)
    } else {
        Advertise::of::<Twist>(command, Qos::RELIABLE, SMALL)
    };
    Interface {
        subscriptions,
        publications: vec![
            command,
            Advertise::of::<LeaderState>(format!("/{robot}/leader_state"), Qos::RELIABLE, STATE),
            Advertise::of::<DiagnosticArray>("/diagnostics", Qos::RELIABLE, Local::NetworkOnly),
        ],
        ..Interface::default()
    }
}

impl FormationController {
    fn take(&mut self, at: Times, port: usize, source: Source, cdr: &[u8]) -> Result<(), Dropped> {
        if matches!(port, TEAM_STATE | GOALS | APPARENT_OBSTACLES) || port >= OTHERS {
            self.masters.entry(port).or_default().admit(source, at.steady)?;
        }
        let inputs = &mut self.tick.inputs;
        match port {
            TEAM_STATE => inputs.take_team(at, TeamState::decode(cdr)?)?,
            GOALS => inputs.take_goals(at, Goals::decode(cdr)?)?,
            ASSIGNMENT => inputs.assignment = Some(Assignment::decode(cdr)?),
            FORMATION => inputs.segments = Some(Arc::new(Segments::of(&Formation::decode(cdr)?))),
            RUN_STATE => inputs.run = Some(RunState::decode(cdr)?),
            APPARENT_OBSTACLES => {
                let message = Hull::all(&ApparentObstacleArray::decode(cdr)?);
                inputs.obstacles = Some(Heard { at: at.steady, message });
            }
            EMERGENCY_STOP => inputs.emergency_stop = Bool::decode(cdr)?.data,
            LINK => {
                let link = LinkStatus::decode(cdr)?;
                if self.tick.settings.team_link_by_radio && link.up {
                    self.tick.team_link.report(at.steady, link.hears);
                }
            }
            _ => {
                let state = LeaderState::decode(cdr)?;
                let carried = |name: &&String| self.tick.team_link.carries(at.steady, name);
                if let Some(name) = self.others.get(port - OTHERS).filter(carried) {
                    inputs.take_other(at, name, state)?;
                }
            }
        }
        Ok(())
    }

    /// Tells once of gains that the operator allowed against the theory, at the start or after a change.
    fn warn(&mut self, sink: &mut dyn Sink) {
        if let Some(warning) = self.warning.take() {
            sink.log(Level::Warn, &warning);
            self.health.set("gains", Condition::Warn, warning);
        }
    }

    fn drive(&mut self, at: Times, sink: &mut dyn Sink) {
        let command = self.tick.run(at);
        self.wakeup = Some(at.steady.plus_seconds(self.tick.settings.watchdog));
        self.send(at, &command, sink);
        self.tell_link(&command);
        let (condition, text) = match &command.hold {
            None => (Condition::Ok, "driving".to_owned()),
            Some(hold) => (hold.condition(), hold.to_string()),
        };
        self.health.set("motion", condition, text);
        self.health.value("motion", "limits", command.limits);
    }

    /// Says how the team link is, under laws that need it.
    fn tell_link(&mut self, command: &Command) {
        if !self.tick.settings.dynamic.as_ref().is_some_and(|dynamic| dynamic.law.is_chained()) {
            return;
        }
        let (condition, text) = match command.beyond_reach {
            _ if command.lost => {
                (Condition::Warn, "hears nobody of its queue: along the segment to the team goal (6.2.1)".to_owned())
            }
            Some(apart) => (Condition::Warn, format!("the robot ahead is {apart:.2} m away, beyond rho_bar")),
            None => (Condition::Ok, "in order".to_owned()),
        };
        self.health.set("team link", condition, text);
    }

    fn send(&mut self, at: Times, command: &Command, sink: &mut dyn Sink) {
        let mut twist = Twist::default();
        (twist.linear.x, twist.angular.z) = (command.twist.v, command.twist.omega);
        if self.tick.settings.stamped {
            let frame_id = format!("{}/base_link", self.tick.settings.robot);
            // The exposure in which the robot was seen: the bridge keeps it from acting on older information.
            let unseen = self.tick.inputs.robot(&self.tick.settings.robot).map_or(0.0, unseen);
            let header = Header { stamp: command.exposure.plus_seconds(-unseen).into(), frame_id };
            sink.publish(CMD_VEL, &TwistStamped { header, twist });
        } else {
            sink.publish(CMD_VEL, &twist);
        }
        if command.pose.is_some() {
            let message = self.leader_state(at, command);
            sink.publish(LEADER_STATE, &message);
        }
    }

    fn leader_state(&self, at: Times, command: &Command) -> LeaderState {
        let (settings, inputs) = (&self.tick.settings, &self.tick.inputs);
        let state = inputs.robot(&settings.robot);
        let position = state.map_or(Vector2::zeros(), |state| Vector2::new(state.x, state.y));
        let velocity = state.map_or(Vector2::zeros(), |state| {
            let (sin, cos) = libm::sincos(state.theta);
            state.v * Vector2::new(cos, sin)
        });
        let (steered, steered_velocity) = self.tick.steered_point(command).unwrap_or((position, velocity));
        let wanted = command.wanted;
        let mut message = LeaderState {
            header: Header { stamp: command.exposure.into(), frame_id: "map".to_owned() },
            robot: settings.robot.clone(),
            hears: inputs.hears(at.steady, settings.leader_state_age_limit).map(str::to_owned).collect(),
            position: point(position),
            theta: state.map_or(0.0, |state| state.theta),
            velocity: point(velocity),
            acceleration: wanted.map(|wanted| point(wanted.acceleration)).unwrap_or_default(),
            point: point(steered),
            point_velocity: point(steered_velocity),
            goal: wanted.and_then(|wanted| wanted.drawn).map(point).unwrap_or_default(),
            goal_distance: wanted.map_or(0.0, |wanted| wanted.distance),
            lyapunov: wanted.map_or(0.0, |wanted| wanted.lyapunov.value),
            lyapunov_rate: wanted.map_or(0.0, |wanted| wanted.lyapunov.rate),
            limited_by: command.limits,
            ..LeaderState::default()
        };
        if let Some(assignment) = &inputs.assignment {
            (message.epoch, message.formation_hash) = (assignment.epoch, assignment.formation_hash);
            if let Some(member) = assignment.members.iter().find(|member| member.robot == settings.robot) {
                (message.queue, message.rank) = (member.queue, member.rank);
            }
        }
        if let Some((distance, tolerance)) = self.tick.segment_distance(command) {
            message.segment_distance = distance;
            message.conforms = distance <= tolerance;
        }
        message
    }

    fn dropped(&mut self, error: &Dropped, port: usize, sink: &mut dyn Sink) {
        self.bad_messages += 1;
        let topic = &self.interface.subscriptions[port].topic;
        self.health.set("messages", Condition::Warn, format!("a message on {topic} was dropped: {error}"));
        self.health.value("messages", "dropped", self.bad_messages);
        if self.bad_messages == 1 {
            sink.log(Level::Warn, &format!("a message on {topic} was dropped: {error}"));
        }
    }
}

impl NodeCore for FormationController {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        self.warn(sink);
        match event {
            Event::Started => self.wakeup = Some(at.steady.plus_seconds(self.tick.settings.watchdog)),
            Event::Message { port, source, cdr } => match self.take(at, port, source, cdr) {
                // The team state is the tick (invariant 10); an emergency stop does not wait for it.
                Ok(()) if port == TEAM_STATE || port == EMERGENCY_STOP => self.drive(at, sink),
                Ok(()) => {}
                Err(error) => self.dropped(&error, port, sink),
            },
            Event::Wakeup => self.drive(at, sink),
            Event::Shutdown => self.send(at, &self.tick.rest(at), sink),
            _ => {}
        }
        self.health.publish(at, DIAGNOSTICS, sink);
    }

    fn next_wakeup(&self) -> Option<Steady> {
        self.wakeup
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        let settings = Settings::read(parameters, &format!("/{}", self.tick.settings.robot))?;
        self.warning = admit_gains(parameters)?;
        if self.warning.is_none() {
            self.health.set("gains", Condition::Ok, "in the stable zone");
        }
        self.tick.settings = settings;
        Ok(())
    }
}
