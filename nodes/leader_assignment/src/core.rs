//! The node core: what it is connected to, and which event goes where.

use crate::checkpoint::{self, Checkpoint};
use crate::held::Held;
use crate::organise::Seated;
use crate::settings::{Settings, descriptors, seating, target_limits, team_limits};
use crate::team::Team;
use crate::tick::longest_goals;
use crate::{RunMachine, Target};
use std::collections::BTreeMap;
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Advertise, Event, Files, FromTheFuture, Health, Interface, JumpWatch, Local, Master, NodeContext, NodeCore,
    NodeDescription, NotMaster, Qos, Refusals, RosTime, Serve, Sink, Source, StartError, Steady, Subscribe, Times,
    resolve_name,
};
use trench_msgs::cdr::CdrError;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::SetFormation;
use trench_msgs::msg::{Assignment, Formation, Goals, LeaderState, LinkStatus, RunState, TeamState};
use trench_msgs::nav_msgs::Odometry;
use trench_msgs::std_srvs::Trigger;
use trench_msgs::visualization_msgs::MarkerArray;
use trench_msgs::{Encode, Message};

const TEAM_STATE: usize = 0;
const TARGET: usize = 1;
const SET_FORMATION: usize = 2;
/// The robots' leader states follow from here on, and then their links.
const ROBOTS: usize = 3;

pub(crate) const FORMATION: usize = 0;
pub(crate) const ASSIGNMENT: usize = 1;
pub(crate) const GOALS: usize = 2;
pub(crate) const RUN_STATE: usize = 3;
const DIAGNOSTICS: usize = 4;
pub(crate) const MARKERS: usize = 5;

/// Why a message was dropped.
#[derive(Debug, thiserror::Error)]
enum Dropped {
    #[error(transparent)]
    Cdr(#[from] CdrError),
    #[error(transparent)]
    NotMaster(#[from] NotMaster),
    #[error("a number in it is not finite")]
    NotFinite,
    #[error(transparent)]
    Future(#[from] FromTheFuture),
    #[error("it is more than {past} s old", past = Times::PAST)]
    Past,
}

/// Who goes where, and when.
pub struct LeaderAssignment {
    interface: Interface,
    pub(crate) settings: Settings,
    pub(crate) run: RunMachine,
    /// The formation in force, and who takes part in it.
    pub(crate) held: Held,
    /// Hash of the formation the process was started with.
    pub(crate) configured: u64,
    pub(crate) assignment: Option<Assignment>,
    pub(crate) seats: Vec<Seated>,
    /// What an earlier life of the process left, until it is looked at.
    pub(crate) checkpoint: Option<Checkpoint>,
    pub(crate) team: Option<TeamState>,
    /// Who writes each topic, by port.
    masters: BTreeMap<usize, Master>,
    /// Who is gone, and who does not hear whom.
    pub(crate) members: Team,
    /// When the bridge told of a robot's radio last.
    pub(crate) linked: Option<Steady>,
    pub(crate) radio_is_silent: bool,
    pub(crate) target: Target,
    pub(crate) targets_refused: u64,
    pub(crate) health: Health,
    refusals: Refusals,
    wakeup: Option<Steady>,
    jumps: JumpWatch,
    pub(crate) last_picture: Option<Steady>,
}

/// The node as processes and the simulator make it.
#[must_use]
pub fn description() -> NodeDescription {
    NodeDescription {
        name: "leader_assignment",
        about: "Assigns robots to queues, orders teams into chains, publishes goals and the run state",
        parameters: descriptors,
        build,
    }
}

fn build(context: &NodeContext, parameters: &Parameters, files: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let (settings, plan) = Settings::read(parameters, files)?;
    let checkpoint = context.checkpoint.as_deref().and_then(checkpoint::read);
    let held = Held::new(plan, settings.robots.clone());
    Ok(Box::new(LeaderAssignment {
        interface: interface(&settings.robots),
        health: Health::new(resolve_name("~", &context.namespace, &context.name)),
        refusals: Refusals::default(),
        configured: held.message.hash,
        held,
        target: Target::new(settings.target),
        settings,
        run: RunMachine::default(),
        assignment: None,
        seats: Vec::new(),
        checkpoint,
        team: None,
        masters: BTreeMap::new(),
        members: Team::default(),
        linked: None,
        radio_is_silent: false,
        targets_refused: 0,
        wakeup: None,
        jumps: JumpWatch::default(),
        last_picture: None,
    }))
}

fn interface(robots: &[String]) -> Interface {
    let max_len = longest_goals(robots).encoded_len();
    let mut services: Vec<Serve> =
        ["arm", "start", "stop", "reset"].map(|name| Serve::of::<Trigger>(format!("~/{name}"))).into();
    services.push(Serve::of::<SetFormation>("~/set_formation"));
    let mut subscriptions = vec![
        Subscribe::to::<TeamState>("/team_state", Qos::RELIABLE),
        Subscribe::to::<Odometry>("/target", Qos::RELIABLE),
        Subscribe::to::<Formation>("/set_formation", Qos::RELIABLE),
    ];
    // What robots say of themselves is looked at with the next team state, and wakes nobody.
    let leader_state =
        |name: &String| Subscribe::to::<LeaderState>(format!("/{name}/leader_state"), Qos::RELIABLE).without_waking();
    let link = |name: &String| Subscribe::to::<LinkStatus>(format!("/{name}/link"), Qos::RELIABLE).without_waking();
    subscriptions.extend(robots.iter().map(leader_state).chain(robots.iter().map(link)));
    Interface {
        subscriptions,
        publications: vec![
            Advertise::of::<Formation>("/formation", Qos::LATCHED, Local::NetworkOnly),
            Advertise::of::<Assignment>("/assignment", Qos::LATCHED, Local::NetworkOnly),
            Advertise::of::<Goals>("/goals", Qos::RELIABLE, Local::SharedMemory { max_len }),
            Advertise::of::<RunState>("/run_state", Qos::LATCHED, Local::NetworkOnly),
            Advertise::of::<DiagnosticArray>("/diagnostics", Qos::RELIABLE, Local::NetworkOnly),
            Advertise::of::<MarkerArray>("/markers", Qos::RELIABLE, Local::NetworkOnly),
        ],
        services,
        ..Interface::default()
    }
}

impl LeaderAssignment {
    fn take(&mut self, at: Times, port: usize, source: Source, cdr: &[u8], sink: &mut dyn Sink) -> Result<(), Dropped> {
        // Formations are asked for by whoever likes.
        if port == SET_FORMATION {
            self.formation_asked(at, &Formation::decode(cdr)?, sink);
            return Ok(());
        }
        self.masters.entry(port).or_default().check(source, at.steady, Master::SILENCE)?;
        if self.understand(at, port, cdr, sink)? {
            self.masters.entry(port).or_default().pin(source, at.steady);
        }
        Ok(())
    }

    /// Takes a message of somebody who may write it; whether it counts.
    fn understand(&mut self, at: Times, port: usize, cdr: &[u8], sink: &mut dyn Sink) -> Result<bool, Dropped> {
        match port {
            TEAM_STATE => self.tick(at, readable(at, cdr)?, sink),
            TARGET => return Ok(self.hear_target(at, &Odometry::decode(cdr)?, sink)),
            _ => self.hear_of_robot(at, port - ROBOTS, cdr)?,
        }
        Ok(true)
    }

    fn hear_of_robot(&mut self, at: Times, index: usize, cdr: &[u8]) -> Result<(), CdrError> {
        let robots = &self.settings.robots;
        if let Some(robot) = robots.get(index) {
            self.members.controller(at, robot, LeaderState::decode(cdr)?);
        } else if let Some(robot) = robots.get(index - robots.len()) {
            self.members.radio(robot, &LinkStatus::decode(cdr)?);
            self.linked = Some(at.steady);
        }
        Ok(())
    }

    /// A robot that is the target (parameter `target.robot`) is heard of with the team; others say where they are. Whether that is
    /// believed.
    fn hear_target(&mut self, at: Times, odometry: &Odometry, sink: &mut dyn Sink) -> bool {
        if !self.settings.target_robot.is_empty() {
            return false;
        }
        let heard = self.target.hear(at, odometry);
        let is_believed = heard.is_ok();
        self.judge_target(heard, sink);
        is_believed
    }
}

/// A team state that goals can be made of.
fn readable(at: Times, cdr: &[u8]) -> Result<TeamState, Dropped> {
    let team = TeamState::decode(cdr)?;
    let stamp = RosTime::from(&team.header.stamp);
    if !team.is_finite() {
        return Err(Dropped::NotFinite);
    }
    at.timely(stamp)?;
    if at.is_past(stamp) { Err(Dropped::Past) } else { Ok(team) }
}

impl NodeCore for LeaderAssignment {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        if let Some(jump) = self.jumps.look(at) {
            self.clock_jumped(at, jump, sink);
        }
        match event {
            Event::Started => {
                self.started(at, sink);
                self.wakeup = Some(at.steady.plus_seconds(1.0));
            }
            Event::Message { port, source, cdr, .. } => {
                if let Err(error) = self.take(at, port, source, cdr, sink) {
                    self.refusals.tell_dropped(at.steady, (&self.interface, port), error, &mut self.health, sink);
                }
            }
            Event::Request { service, id, cdr } => self.serve(at, (service, id), cdr, sink),
            Event::Wakeup => {
                self.wakeup = Some(at.steady.plus_seconds(1.0));
                self.follow_structure(at, sink);
                if self.run.running() {
                    self.keep(at, sink);
                }
            }
            Event::Shutdown => {
                if self.run.end() {
                    self.announce(at, sink);
                }
                // A clean end leaves nothing to go on with.
                sink.checkpoint(&[]);
            }
            _ => {}
        }
        self.refusals.settle(at.steady, &mut self.health);
        self.health.publish(at, DIAGNOSTICS, sink);
    }

    fn next_wakeup(&self) -> Option<Steady> {
        self.wakeup
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        let (seating, target) = (seating(parameters)?, target_limits(parameters)?);
        self.settings.team = team_limits(parameters)?;
        (self.settings.seating, self.settings.target) = (seating, target);
        self.target.set_limits(target);
        Ok(())
    }
}
