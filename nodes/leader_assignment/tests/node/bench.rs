//! The node with all that it hears and says.

use leader_assignment::description;
use trench_config::params::{Source, resolve};
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Action, Event, Files, NodeContext, NodeCore, Outbox, RequestId, RosTime, Source as From, Steady, Times,
};
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::{
    Assignment, LeaderState, LinkStatus, RobotState, SetFormationRequest, SetFormationResponse, TeamState,
};
use trench_msgs::std_srvs::{TriggerRequest, TriggerResponse};
use trench_msgs::{Encode, Message};

pub(crate) struct Shipped;

impl Files for Shipped {
    fn read(&self, key: &str, path: &str) -> Result<String, ConfigError> {
        let path = format!("{}/../../{path}", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(path).map_err(|error| Parameters::default().error(key, error.to_string(), "a file"))
    }
}

pub(crate) const FILE: (&str, &str) = ("formation_file", "config/formations/square.yaml");
pub(crate) const ROBOTS: (&str, &str) = ("robots", "[robot1, robot2, robot3, robot4]");

/// A queue of one place, half a metre behind the target.
pub(crate) struct OnTarget;

impl Files for OnTarget {
    fn read(&self, _: &str, _: &str) -> Result<String, ConfigError> {
        Ok("name: wing\nframe: target\nqueues:\n- name: left\n  \
            segment: {kind: line, points: [[-1.0, 0.0], [0.0, 0.0]]}\n  vertices: [[-0.5, 0.0]]\n  \
            share: 1.0\n  tolerance: 0.02\n"
            .to_owned())
    }
}

pub(crate) fn make(overrides: &[(&str, &str)], checkpoint: Option<Vec<u8>>) -> Result<Box<dyn NodeCore>, String> {
    make_of(overrides, checkpoint, &Shipped)
}

pub(crate) fn make_of(
    overrides: &[(&str, &str)],
    checkpoint: Option<Vec<u8>>,
    files: &dyn Files,
) -> Result<Box<dyn NodeCore>, String> {
    let sources: Vec<Source<'_>> =
        overrides.iter().map(|(name, value)| Source::Override { node: None, name, value }).collect();
    let node = description();
    let parameters = resolve(&sources, "/", node.name, &(node.parameters)()).map_err(|errors| errors[0].to_string())?;
    let context =
        NodeContext { namespace: "/".to_owned(), name: node.name.to_owned(), checkpoint, ..Default::default() };
    (node.build)(&context, &parameters, files).map_err(|error| error.to_string())
}

pub(crate) struct Bench {
    pub(crate) core: Box<dyn NodeCore>,
    pub(crate) out: Outbox,
    pub(crate) seconds: f64,
    /// The last one before the last call of a service.
    pub(crate) assignment: Option<Assignment>,
}

impl Bench {
    pub(crate) fn new(seconds: f64, checkpoint: Option<Vec<u8>>) -> Self {
        Self::of(make(&[FILE, ROBOTS], checkpoint).unwrap(), seconds)
    }

    pub(crate) fn of(core: Box<dyn NodeCore>, seconds: f64) -> Self {
        let mut bench = Self { core, out: Outbox::default(), seconds, assignment: None };
        bench.handle(Event::Started);
        bench
    }

    pub(crate) fn handle(&mut self, event: Event<'_>) {
        let at = Times { ros: RosTime(0).plus_seconds(self.seconds), steady: Steady(0).plus_seconds(self.seconds) };
        self.core.handle(at, event, &mut self.out);
    }

    pub(crate) fn call(&mut self, name: &str) -> TriggerResponse {
        let service = self.core.interface().services.iter().position(|serve| serve.name.ends_with(name)).unwrap();
        self.assignment = self.last("/assignment").or(self.assignment.take());
        self.out.take();
        let cdr = TriggerRequest::default().to_cdr();
        self.handle(Event::Request { service, id: RequestId(1), cdr: &cdr });
        let answer = self.out.actions.iter().find_map(|action| match action {
            Action::Respond { cdr, .. } => Some(TriggerResponse::decode(cdr).unwrap()),
            _ => None,
        });
        answer.unwrap()
    }

    pub(crate) fn set_formation(&mut self, name: &str, scale: f64, robots: &[&str]) -> SetFormationResponse {
        let service =
            self.core.interface().services.iter().position(|serve| serve.name.ends_with("set_formation")).unwrap();
        self.out.take();
        let robots = robots.iter().map(|robot| (*robot).to_owned()).collect();
        let cdr = SetFormationRequest { name: name.to_owned(), scale, robots }.to_cdr();
        self.handle(Event::Request { service, id: RequestId(1), cdr: &cdr });
        let answer = self.out.actions.iter().find_map(|action| match action {
            Action::Respond { cdr, .. } => Some(SetFormationResponse::decode(cdr).unwrap()),
            _ => None,
        });
        answer.unwrap()
    }

    pub(crate) fn send(&mut self, topic: &str, message: &dyn Encode) {
        self.send_from([0; 16], topic, message);
    }

    /// A message of the writer `gid`.
    pub(crate) fn send_from(&mut self, gid: [u8; 16], topic: &str, message: &dyn Encode) {
        let port = self.core.interface().subscriptions.iter().position(|subscribe| subscribe.topic == topic).unwrap();
        let cdr = message.to_cdr();
        self.handle(Event::Message { port, source: From { gid, sequence: 0 }, cdr: &cdr, arrived: None });
    }

    pub(crate) fn see(&mut self, status: u8) {
        let starts = [(0.15, 0.25), (0.95, 0.20), (0.20, 1.60), (0.90, 1.55)];
        let robot = |(index, (x, y)): (usize, (f64, f64))| RobotState {
            name: format!("robot{}", index + 1),
            status,
            x,
            y,
            ..Default::default()
        };
        self.see_robots(starts.into_iter().enumerate().map(robot).collect());
    }

    pub(crate) fn see_robots(&mut self, robots: Vec<RobotState>) {
        let mut team = TeamState { robots, ..Default::default() };
        team.header.stamp = RosTime(0).plus_seconds(self.seconds).into();
        let cdr = team.to_cdr();
        self.handle(Event::Message { port: 0, source: Default::default(), cdr: &cdr, arrived: None });
    }

    /// So many seconds of frames in which the robots of `speakers` say whom they hear; `silent` names radios that are down.
    pub(crate) fn live(&mut self, seconds: f64, speakers: &[(&str, &[&str])], silent: &[&str]) {
        for _ in 0..(10.0 * seconds) as u32 {
            self.seconds += 0.1;
            self.speak(speakers, silent);
            self.see(RobotState::STATUS_TRACKED);
        }
    }

    pub(crate) fn speak(&mut self, speakers: &[(&str, &[&str])], silent: &[&str]) {
        for (robot, hears) in speakers {
            let hears = hears.iter().map(|name| (*name).to_owned()).collect();
            self.send(&format!("/{robot}/leader_state"), &LeaderState { hears, ..Default::default() });
            let link = LinkStatus { up: !silent.contains(robot), ..Default::default() };
            self.send(&format!("/{robot}/link"), &link);
        }
    }

    /// The last assignment.
    pub(crate) fn assigned(&self) -> Assignment {
        self.last("/assignment").or(self.assignment.clone()).unwrap()
    }

    /// Robot and leader of each member of the last assignment.
    pub(crate) fn chains(&self) -> Vec<(String, String)> {
        self.assigned().members.into_iter().map(|member| (member.robot, member.leader)).collect()
    }

    pub(crate) fn last<M: Message>(&self, topic: &str) -> Option<M> {
        let port = self.core.interface().publications.iter().position(|advertise| advertise.topic == topic).unwrap();
        self.out.last(port)
    }

    pub(crate) fn checkpoint(&self) -> Vec<u8> {
        let kept = self.out.actions.iter().rev().find_map(|action| match action {
            Action::Checkpoint(bytes) => Some(bytes.clone()),
            _ => None,
        });
        kept.unwrap()
    }

    pub(crate) fn running() -> Self {
        Self::running_with(&[])
    }

    /// With further parameters.
    pub(crate) fn running_with(further: &[(&str, &str)]) -> Self {
        let mut bench = Self::of(make(&[&[FILE, ROBOTS][..], further].concat(), None).unwrap(), 100.0);
        bench.see(RobotState::STATUS_TRACKED);
        assert!(bench.call("arm").success);
        assert!(bench.call("start").success);
        bench.seconds += 1.0;
        bench.see(RobotState::STATUS_TRACKED);
        bench
    }
}

/// Level and text of what the node says last of one of its parts.
pub(crate) fn said(bench: &Bench, part: &str) -> (u8, String) {
    let port = bench.core.interface().publications.iter().position(|topic| topic.topic == "/diagnostics").unwrap();
    let said = bench.out.actions.iter().rev().find_map(|action| match action {
        Action::Publish { port: of, cdr } if *of == port => {
            let mut status = DiagnosticArray::decode(cdr).unwrap().status.into_iter();
            status.find(|status| status.name.ends_with(part)).map(|status| (status.level, status.message))
        }
        _ => None,
    });
    said.unwrap()
}
