//! The node core: events in, ticks, messages out.

use crate::inputs::{Heard, Hulls, Spoken};
use crate::monitor::Violation;
use crate::ports::{
    APPARENT_OBSTACLES, ASSIGNMENT, CMD_VEL, DIAGNOSTICS, EMERGENCY_STOP, FORMATION, GOALS, LEADER_STATE, LINK,
    MARKERS, OTHERS, OWN, RUN_STATE, STABILITY, TEAM_STATE, interface,
};
use crate::refusal::Refusal;
use crate::robot::unseen;
use crate::segments::Segments;
use crate::settings::{Settings, check_gains, descriptors};
use crate::tick::{Command, Tick};
use std::collections::BTreeMap;
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Condition, Event, Files, Health, Interface, Level, Master, NodeContext, NodeCore, NodeDescription, NotMaster,
    Refusals, Sink, Source, StartError, Steady, Times, resolve_name,
};
use trench_msgs::Message;
use trench_msgs::cdr::CdrError;
use trench_msgs::geometry_msgs::{Twist, TwistStamped};
use trench_msgs::msg::{
    ApparentObstacleArray, Assignment, Formation, Goals, Identify, LeaderStateView, LinkStatus, RunState, TeamState,
};
use trench_msgs::std_msgs::{Bool, Float64, Header};

/// Between two words of the monitor where nothing changes, s: a little less than a tenth.
const STABILITY_PERIOD: f64 = 0.095;

/// What is said of a robot that moves otherwise than it is told.
const STRAYS: &str =
    "driving, but the robot does not move as told: a wheel slips or is stuck, something holds it, or the radio is gone";

/// Why a message was dropped.
#[derive(Debug, thiserror::Error)]
enum Dropped {
    #[error(transparent)]
    Cdr(#[from] CdrError),
    #[error(transparent)]
    Refused(#[from] Refusal),
    #[error(transparent)]
    NotMaster(#[from] NotMaster),
    #[error("another publisher writes this topic, and its word is that of the goals")]
    Other,
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
    /// When the monitor's word was published, and whether it was that all holds.
    told: Option<(Steady, bool)>,
    /// When it was drawn last.
    drawn: Option<Steady>,
    refusals: Refusals,
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
    let warning = admit_gains(parameters, &settings)?;
    let mut tick = Tick::new(settings.clone());
    tick.unstable_gains = warning.clone();
    let others: Vec<String> = settings.team.iter().filter(|name| **name != settings.robot).cloned().collect();
    Ok(Box::new(FormationController {
        interface: interface(&settings, &others),
        health: Health::new(resolve_name("~", &context.namespace, &context.name)),
        tick,
        others,
        masters: BTreeMap::new(),
        wakeup: None,
        told: None,
        drawn: None,
        refusals: Refusals::default(),
        warning,
    }))
}

/// Refuses gains outside the stable zone, or gives the warning where the operator allows them.
fn admit_gains(parameters: &Parameters, settings: &Settings) -> Result<Option<String>, ConfigError> {
    match check_gains(parameters, settings) {
        Err(refusal) if parameters.bool("refuse_unstable_gains")? => Err(refusal),
        Err(refusal) => Ok(Some(refusal.to_string())),
        Ok(()) => Ok(None),
    }
}

impl FormationController {
    /// Takes a message; whether a command is due now: the team state is the tick (invariant 10), and an emergency stop does not wait
    /// for it.
    fn take(&mut self, at: Times, port: usize, source: Source, cdr: &[u8]) -> Result<bool, Dropped> {
        if let Some(name) = port.checked_sub(OTHERS).and_then(|index| self.others.get(index)) {
            self.tick.inputs.voices.hear(name, source.gid, at.steady);
        }
        if !(matches!(port, TEAM_STATE | GOALS | APPARENT_OBSTACLES | LINK) || port >= OTHERS) {
            return self.understand(at, port, source, cdr);
        }
        self.masters.entry(port).or_default().check(source, at.steady, Master::SILENCE)?;
        let taken = self.understand(at, port, source, cdr);
        let master = self.masters.entry(port).or_default();
        let counts = match &taken {
            Ok(_) => !self.tick.inputs.stamp(port).is_some_and(|stamp| at.is_past(stamp)),
            Err(Dropped::Refused(refusal)) => refusal.is_late() && master.is(source),
            Err(_) => false,
        };
        if counts {
            master.pin(source, at.steady);
        }
        taken
    }

    /// Takes a message of somebody who may write it.
    fn understand(&mut self, at: Times, port: usize, source: Source, cdr: &[u8]) -> Result<bool, Dropped> {
        let inputs = &mut self.tick.inputs;
        let mut urgent = port == TEAM_STATE;
        match port {
            TEAM_STATE => inputs.take_team(at, TeamState::decode(cdr)?)?,
            GOALS => inputs.take_goals(at, Goals::decode(cdr)?)?,
            ASSIGNMENT => {
                let before = inputs.queue(&self.tick.settings.robot);
                let counts = inputs.take_assignment(source.gid, Assignment::decode(cdr)?);
                if inputs.queue(&self.tick.settings.robot) != before {
                    self.tick.renew();
                }
                return if counts { Ok(false) } else { Err(Dropped::Other) };
            }
            FORMATION => {
                if !inputs.take_formation(source.gid, Segments::of(&Formation::decode(cdr)?)) {
                    return Err(Dropped::Other);
                }
                self.tick.renew();
            }
            RUN_STATE => {
                if !inputs.take_run(source.gid, RunState::decode(cdr)?) {
                    return Err(Dropped::Other);
                }
            }
            APPARENT_OBSTACLES => {
                inputs.take_hulls(at, Hulls::of(&ApparentObstacleArray::decode(cdr)?)?)?;
            }
            EMERGENCY_STOP => {
                let stop = Bool::decode(cdr)?.data;
                urgent = stop && !inputs.emergency_stop;
                inputs.emergency_stop = stop;
            }
            LINK => {
                let link = LinkStatus::decode(cdr)?;
                if self.tick.settings.team_link_by_radio && link.up {
                    self.tick.team_link.report(at.steady, link.hears);
                }
            }
            OWN => inputs.voices.hear(&self.tick.settings.robot, source.gid, at.steady),
            _ => match self.others.get(port - OTHERS) {
                Some(name) => {
                    let state = LeaderStateView::decode(cdr)?;
                    if self.tick.team_link.carries(at.steady, name) {
                        inputs.take_other(at, name, Spoken::from(&state))?;
                    }
                }
                None if port > OTHERS + self.others.len() => inputs.loop_delay = Some(Float64::decode(cdr)?.data),
                None => inputs.identify = Some(Heard { at: at.steady, message: Identify::decode(cdr)? }),
            },
        }
        Ok(urgent)
    }

    /// Tells once of gains that the operator allowed against the theory, at the start or after a change.
    fn warn(&mut self, sink: &mut dyn Sink) {
        if let Some(warning) = self.warning.take() {
            sink.log(Level::Warn, &warning);
            self.health.set("gains", Condition::Warn, warning);
        }
    }

    fn drive(&mut self, at: Times, sink: &mut dyn Sink) {
        let period = self.tick.settings.picture_period;
        let due = self.drawn.is_none_or(|last| at.steady.seconds_since(last) >= period);
        self.tick.draws = period > 0.0 && due;
        let command = self.tick.run(at);
        self.wakeup = Some(at.steady.plus_seconds(self.tick.settings.watchdog));
        self.send(at, &command, sink);
        self.tell_link(&command);
        let (condition, text) = match &command.hold {
            None if command.strays => (Condition::Warn, STRAYS.to_owned()),
            None => (Condition::Ok, "driving".to_owned()),
            Some(hold) => (hold.condition(), hold.to_string()),
        };
        self.health.set("motion", condition, text);
        self.health.value("motion", "limits", command.limits);
        self.tell_doubled(at);
        self.tell_stability(at, &command, sink);
        if let Some(picture) = self.tick.picture.take() {
            self.drawn = Some(at.steady);
            sink.publish(MARKERS, &picture);
        }
    }

    fn tell_doubled(&mut self, at: Times) {
        let doubled: Vec<&str> = self.tick.inputs.voices.doubled(at.steady).collect();
        match doubled[..] {
            [] => self.health.set("controllers", Condition::Ok, "one a robot"),
            _ => {
                let message = format!("two controllers drive {}", doubled.join(", "));
                self.health.set("controllers", Condition::Error, message);
            }
        }
    }

    /// Publishes what the monitor says: at once where it changes, and ten times a second.
    fn tell_stability(&mut self, at: Times, command: &Command, sink: &mut dyn Sink) {
        let Some((message, violation)) = self.tick.stability(command) else {
            self.health.set("stability", Condition::Ok, "no law is in force");
            return;
        };
        let condition = violation.as_ref().map_or(Condition::Ok, Violation::condition);
        let text = if message.holds { format!("{} holds", message.equation) } else { message.violation.clone() };
        self.health.set("stability", condition, text);
        let due = self
            .told
            .is_none_or(|(last, held)| held != message.holds || at.steady.seconds_since(last) >= STABILITY_PERIOD);
        if due {
            self.told = Some((at.steady, message.holds));
            sink.publish(STABILITY, &message);
        }
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
            let message = self.tick.leader_state(at, command);
            sink.publish(LEADER_STATE, &message);
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
            Event::Message { port, source, cdr, .. } => match self.take(at, port, source, cdr) {
                Ok(true) => self.drive(at, sink),
                Ok(false) => {}
                Err(error) => {
                    self.refusals.tell_dropped(at.steady, (&self.interface, port), error, &mut self.health, sink);
                }
            },
            Event::Wakeup => self.drive(at, sink),
            Event::Shutdown => self.send(at, &self.tick.rest(at), sink),
            _ => {}
        }
        self.refusals.settle(at.steady, &mut self.health);
        self.health.publish(at, DIAGNOSTICS, sink);
    }

    fn next_wakeup(&self) -> Option<Steady> {
        self.wakeup
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        let settings = Settings::read(parameters, &format!("/{}", self.tick.settings.robot))?;
        self.warning = admit_gains(parameters, &settings)?;
        self.tick.unstable_gains = self.warning.clone();
        if self.warning.is_none() {
            self.health.set("gains", Condition::Ok, "in the stable zone");
        }
        self.tick.set(settings);
        Ok(())
    }
}
