//! The node core.

use crate::checkpoint::{self, Checkpoint, FRESH};
use crate::organise::{Seated, organise};
use crate::settings::{Settings, descriptors};
use crate::virtual_point::{Carrier, virtual_point};
use crate::{Request, RunMachine, markers};
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Advertise, Condition, Event, Files, Health, Interface, Level, Local, NodeContext, NodeCore, NodeDescription, Qos,
    RequestId, RosTime, Serve, Sink, StartError, Steady, Subscribe, Times, resolve_name,
};
use trench_formation::Vector2;
use trench_msgs::Message;
use trench_msgs::cdr::CdrError;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::{Assignment, Formation, Goal, Goals, Point2, RobotState, RunState, TeamState};
use trench_msgs::nav_msgs::Odometry;
use trench_msgs::std_msgs::Header;
use trench_msgs::std_srvs::{Trigger, TriggerResponse};
use trench_msgs::visualization_msgs::MarkerArray;

const TEAM_STATE: usize = 0;
const TARGET: usize = 1;

const FORMATION: usize = 0;
const ASSIGNMENT: usize = 1;
const GOALS: usize = 2;
const RUN_STATE: usize = 3;
const DIAGNOSTICS: usize = 4;
const MARKERS: usize = 5;

/// The shortest time between two pictures for viewers, s; a tick that comes a little early counts as due.
const PICTURES: f64 = 0.195;

/// In the order of the services: ~/arm, ~/start, ~/stop, ~/reset.
const REQUESTS: [Request; 4] = [Request::Arm, Request::Start, Request::Stop, Request::Reset];

/// Room for a message about twenty robots in shared memory.
const TEAM: Local = Local::SharedMemory { max_len: 8192 };

/// Who goes where, and when.
pub struct LeaderAssignment {
    interface: Interface,
    settings: Settings,
    run: RunMachine,
    assignment: Option<Assignment>,
    seats: Vec<Seated>,
    /// What an earlier life of the process left, until it is looked at.
    checkpoint: Option<Checkpoint>,
    team: Option<TeamState>,
    target: Option<(Steady, Carrier)>,
    health: Health,
    wakeup: Option<Steady>,
    last_picture: Option<Steady>,
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
    let settings = Settings::read(parameters, files)?;
    let checkpoint = context.checkpoint.as_deref().and_then(checkpoint::read);
    Ok(Box::new(LeaderAssignment {
        interface: interface(),
        health: Health::new(resolve_name("~", &context.namespace, &context.name)),
        settings,
        run: RunMachine::default(),
        assignment: None,
        seats: Vec::new(),
        checkpoint,
        team: None,
        target: None,
        wakeup: None,
        last_picture: None,
    }))
}

fn same_robots(assignment: &Assignment, robots: &[String]) -> bool {
    let mut members: Vec<&String> = assignment.members.iter().map(|member| &member.robot).collect();
    members.sort();
    members.into_iter().eq(robots)
}

fn interface() -> Interface {
    Interface {
        subscriptions: vec![
            Subscribe::to::<TeamState>("/team_state", Qos::RELIABLE),
            Subscribe::to::<Odometry>("/target", Qos::RELIABLE),
        ],
        publications: vec![
            Advertise::of::<Formation>("/formation", Qos::LATCHED, Local::NetworkOnly),
            Advertise::of::<Assignment>("/assignment", Qos::LATCHED, Local::NetworkOnly),
            Advertise::of::<Goals>("/goals", Qos::RELIABLE, TEAM),
            Advertise::of::<RunState>("/run_state", Qos::LATCHED, Local::NetworkOnly),
            Advertise::of::<DiagnosticArray>("/diagnostics", Qos::RELIABLE, Local::NetworkOnly),
            Advertise::of::<MarkerArray>("/markers", Qos::RELIABLE, Local::NetworkOnly),
        ],
        services: ["arm", "start", "stop", "reset"].map(|name| Serve::of::<Trigger>(format!("~/{name}"))).into(),
        ..Interface::default()
    }
}

impl LeaderAssignment {
    /// Takes up the run of an earlier life of the process: one of the same formation and robots that died just now.
    fn resume(&mut self, at: Times, sink: &mut dyn Sink) {
        let hash = self.settings.plan.message(Header::default()).hash;
        let Some(Checkpoint { written, run, assignment: Some(assignment) }) = self.checkpoint.take() else { return };
        let fresh = (0.0..=FRESH).contains(&at.ros.seconds_since(written));
        if !fresh || assignment.formation_hash != hash || !same_robots(&assignment, &self.settings.robots) {
            return;
        }
        sink.log(Level::Info, "going on with the run that was interrupted");
        self.seats = Seated::of_assignment(&self.settings.plan, &assignment);
        (self.run, self.assignment) = (run, Some(assignment));
    }

    fn started(&mut self, at: Times, sink: &mut dyn Sink) {
        self.resume(at, sink);
        let header = Header { stamp: at.ros.into(), frame_id: String::new() };
        sink.publish(FORMATION, &self.settings.plan.message(header));
        if let Some(assignment) = &self.assignment {
            sink.publish(ASSIGNMENT, assignment);
        }
        self.announce(at, sink);
        self.wakeup = Some(at.steady.plus_seconds(1.0));
    }

    fn tick(&mut self, at: Times, team: TeamState, sink: &mut dyn Sink) {
        let stamp = RosTime::from(&team.header.stamp);
        self.team = Some(team);
        if self.unlocalised().is_empty() && self.run.localised(stamp) {
            self.announce(at, sink);
        }
        let goals = self.goals(at, stamp);
        if let Some(goals) = &goals {
            sink.publish(GOALS, goals);
        }
        self.draw(at, stamp, goals.as_ref(), sink);
    }

    /// Shows viewers the formation, now and then.
    fn draw(&mut self, at: Times, stamp: RosTime, goals: Option<&Goals>, sink: &mut dyn Sink) {
        let is_due = self.last_picture.is_none_or(|last| at.steady.seconds_since(last) >= PICTURES);
        let (true, Some(carrier), Some(team)) = (is_due, self.carrier(at), &self.team) else { return };
        self.last_picture = Some(at.steady);
        let mut all = markers::of_plan(stamp.into(), &self.settings.plan, &carrier);
        all.extend(goals.map(|goals| markers::of_goals(stamp.into(), goals)));
        let chains = self.assignment.iter().flat_map(|assignment| markers::of_chains(stamp.into(), team, assignment));
        all.extend(chains);
        sink.publish(MARKERS, &MarkerArray { markers: all });
    }

    /// The goals at `stamp`; none before there is an assignment, or while the frame of the formation is not heard of.
    fn goals(&self, at: Times, stamp: RosTime) -> Option<Goals> {
        let (assignment, team) = (self.assignment.as_ref()?, self.team.as_ref()?);
        let carrier = self.carrier(at)?;
        let elapsed = self.run.t0().map_or(0.0, |t0| stamp.seconds_since(t0));
        let goal = |seat: &Seated| {
            let queue = &self.settings.plan.queues[seat.queue];
            let robot = team.robots.iter().find(|robot| robot.name == seat.robot)?;
            let here = carrier.from_map(Vector2::new(robot.x, robot.y));
            let point = virtual_point(&queue.curve, queue.places[seat.place], self.settings.plan.motion, elapsed, here);
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
        let header = Header { stamp: stamp.into(), frame_id: "map".to_owned() };
        Some(Goals { header, epoch: assignment.epoch, goals })
    }

    fn carrier(&self, at: Times) -> Option<Carrier> {
        if self.settings.target_age_limit.is_infinite() {
            return Some(Carrier::MAP);
        }
        let (heard, carrier) = self.target.as_ref()?;
        (at.steady.seconds_since(*heard) <= self.settings.target_age_limit).then_some(*carrier)
    }

    fn request(&mut self, at: Times, request: Request, sink: &mut dyn Sink) -> TriggerResponse {
        let ready = self.ready();
        let answer = self.run.request(request, ready);
        if answer.is_ok() {
            if matches!(request, Request::Arm | Request::Start) {
                self.assign(at, sink);
            }
            self.announce(at, sink);
        }
        let (success, message) = match answer {
            Ok(message) => (true, message),
            Err(message) => (false, message),
        };
        sink.log(Level::Info, &format!("{request:?}: {message}"));
        TriggerResponse { success, message }
    }

    /// What speaks against moving.
    fn ready(&self) -> Result<(), String> {
        if self.team.is_none() {
            return Err("no /team_state was heard: is the localizer running?".to_owned());
        }
        let missing = self.unlocalised();
        if missing.is_empty() { Ok(()) } else { Err(format!("not localised: {}", missing.join(", "))) }
    }

    fn unlocalised(&self) -> Vec<&str> {
        let tracked = |name: &&String| {
            self.team
                .iter()
                .flat_map(|team| &team.robots)
                .any(|robot| robot.name == **name && robot.status == RobotState::STATUS_TRACKED)
        };
        self.settings.robots.iter().filter(|name| !tracked(name)).map(String::as_str).collect()
    }

    fn assign(&mut self, at: Times, sink: &mut dyn Sink) {
        let (Some(team), Some(carrier)) = (&self.team, self.carrier(at)) else { return };
        let robots: Vec<(String, Vector2<f64>)> = team
            .robots
            .iter()
            .filter(|robot| self.settings.robots.contains(&robot.name))
            .map(|robot| (robot.name.clone(), carrier.from_map(Vector2::new(robot.x, robot.y))))
            .collect();
        match organise(&self.settings.plan, &robots, &self.seats, self.settings.keep_margin) {
            Ok(seats) => self.seats = seats,
            Err(error) => {
                self.health.set("assignment", Condition::Error, error.to_string());
                sink.log(Level::Error, &format!("the assignment stays as it is: {error}"));
                return;
            }
        }
        let header = Header { stamp: at.ros.into(), frame_id: self.settings.plan.frame.id().to_owned() };
        let epoch = self.assignment.as_ref().map_or(0, |old| old.epoch) + 1;
        let formation_hash = self.settings.plan.message(Header::default()).hash;
        let members = self.seats.iter().map(Seated::member).collect();
        let assignment = Assignment { header, epoch, formation_hash, members };
        let same = self.assignment.as_ref().is_some_and(|old| old.members == assignment.members);
        if !same {
            sink.publish(ASSIGNMENT, &assignment);
            self.assignment = Some(assignment);
        }
    }

    fn keep(&self, at: Times, sink: &mut dyn Sink) {
        sink.checkpoint(&checkpoint::write(at.ros, &self.run, self.assignment.as_ref()));
    }

    fn announce(&mut self, at: Times, sink: &mut dyn Sink) {
        self.keep(at, sink);
        sink.publish(
            RUN_STATE,
            &RunState {
                header: Header { stamp: at.ros.into(), frame_id: String::new() },
                state: self.run.state(),
                epoch: self.assignment.as_ref().map_or(0, |assignment| assignment.epoch),
                t0: self.run.t0().map(Into::into).unwrap_or_default(),
                reason: self.run.reason().to_owned(),
            },
        );
    }

    fn take(&mut self, at: Times, port: usize, cdr: &[u8], sink: &mut dyn Sink) -> Result<(), CdrError> {
        match port {
            TEAM_STATE => self.tick(at, TeamState::decode(cdr)?, sink),
            TARGET => self.target = Some((at.steady, carrier_of(&Odometry::decode(cdr)?))),
            _ => {}
        }
        Ok(())
    }

    fn serve(&mut self, at: Times, service: usize, id: RequestId, sink: &mut dyn Sink) {
        if let Some(&request) = REQUESTS.get(service) {
            let response = self.request(at, request, sink);
            sink.respond(service, id, &response);
        }
    }
}

/// The target's frame from its odometry; the twist of an Odometry is in the target's own frame.
fn carrier_of(odometry: &Odometry) -> Carrier {
    let orientation = &odometry.pose.pose.orientation;
    let theta = 2.0 * libm::atan2(orientation.z, orientation.w);
    let (sin, cos) = libm::sincos(theta);
    let twist = &odometry.twist.twist;
    let (ahead, aside) = (twist.linear.x, twist.linear.y);
    Carrier {
        position: Vector2::new(odometry.pose.pose.position.x, odometry.pose.pose.position.y),
        theta,
        velocity: Vector2::new(cos * ahead - sin * aside, sin * ahead + cos * aside),
        omega: twist.angular.z,
    }
}

fn to_message(vector: Vector2<f64>) -> Point2 {
    Point2 { x: vector.x, y: vector.y }
}

impl NodeCore for LeaderAssignment {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Started => self.started(at, sink),
            Event::Message { port, cdr, .. } => {
                if let Err(error) = self.take(at, port, cdr, sink) {
                    let topic = &self.interface.subscriptions[port].topic;
                    self.health.set("messages", Condition::Warn, format!("a message on {topic} was dropped: {error}"));
                }
            }
            Event::Request { service, id, .. } => self.serve(at, service, id, sink),
            Event::Wakeup => {
                self.wakeup = Some(at.steady.plus_seconds(1.0));
                if self.run.running() {
                    self.keep(at, sink);
                }
            }
            // A clean end leaves nothing to go on with.
            Event::Shutdown => sink.checkpoint(&[]),
            _ => {}
        }
        self.health.set(
            "run",
            Condition::Ok,
            format!("{}: {}", crate::state_name(self.run.state()), self.run.reason()),
        );
        self.health.publish(at, DIAGNOSTICS, sink);
    }

    fn next_wakeup(&self) -> Option<Steady> {
        self.wakeup
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        self.settings.keep_margin = parameters.f64("keep_margin")?;
        Ok(())
    }
}
