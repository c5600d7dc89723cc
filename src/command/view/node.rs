//! The node that listens: an ordinary subscriber, through shared memory where the writer is on this host.

use super::hub::Hub;
use std::sync::{Arc, OnceLock};
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::{
    Advertise, Event, Files, Interface, Local, NodeContext, NodeCore, NodeDescription, Qos, Sink, StartError, Steady,
    Times,
};
use trench_msgs::visualization_msgs::MarkerArray;
use trench_view::{Role, subscriptions};

/// The shortest time between two pictures, s.
const PERIOD: f64 = 0.04;
/// How often it looks whether somebody has come, and takes what was said, s.
const LOOK: f64 = 0.1;
/// How often it tells of the picture on /markers, s.
const MARKERS_PERIOD: f64 = 1.0;
/// The publication of markers, where there is one.
const MARKERS: usize = 0;
/// The exit code that means: there are robots that are not listened to yet.
const REJOIN: u8 = 99;
/// Robots that are listened to at most.
const MOST: usize = 200;

/// The process's one picture: nodes are made by plain functions, which can be given nothing else.
static HUB: OnceLock<Arc<Hub>> = OnceLock::new();

/// Runs the node until a signal ends it; gives the exit code. Where no robots are named it joins again when the team
/// has new ones, and keeps its picture.
pub(super) fn run(hub: Arc<Hub>, robots: &[String], ground_truth: bool, markers: bool, further: &[String]) -> u8 {
    let hub = HUB.get_or_init(|| hub);
    hub.robots().extend(robots.iter().cloned());
    loop {
        let names: Vec<String> = hub.robots().iter().map(|robot| format!("'{robot}'")).collect();
        let own = [
            "--ros-args".to_owned(),
            "-p".to_owned(),
            format!("robots:=[{}]", names.join(", ")),
            "-p".to_owned(),
            format!("ground_truth:={ground_truth}"),
            "-p".to_owned(),
            format!("follow_team:={}", robots.is_empty()),
            "-p".to_owned(),
            format!("markers:={markers}"),
            "--".to_owned(),
        ];
        let arguments = own.into_iter().chain(further.iter().cloned());
        trench_runtime::wait_turn(trench_runtime::Turn::Watcher);
        match trench_runtime::run_with_arguments(description(), arguments) {
            REJOIN => {}
            code => return code,
        }
    }
}

fn description() -> NodeDescription {
    NodeDescription { name: "view", about: "Shows the field in a browser", parameters, build }
}

fn parameters() -> Vec<ParameterDescriptor> {
    vec![
        ParameterDescriptor::string_list("robots", &[], "the robots to listen to").read_only(),
        ParameterDescriptor::bool("follow_team", true, "whether to listen to all robots that /team_state tells of")
            .read_only(),
        ParameterDescriptor::bool("ground_truth", false, "whether to show the simulated bed's ground truth")
            .read_only(),
        ParameterDescriptor::bool("markers", false, "whether to publish what the page alone draws on /markers")
            .read_only(),
    ]
}

fn build(_: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let hub = HUB.get().ok_or_else(|| parameters.error("robots", "has no page to show", "start trench view"))?;
    let topics = subscriptions(parameters.str_list("robots")?, parameters.bool("ground_truth")?);
    // Hundreds of messages a second come for some pictures: whoever looks need not be woken by each.
    let at_leisure = topics.into_iter().map(|(role, topic)| (role, topic.without_waking()));
    let (roles, subscriptions) = at_leisure.unzip();
    let markers = Advertise::of::<MarkerArray>("/markers", Qos::RELIABLE, Local::NetworkOnly);
    let publications = if parameters.bool("markers")? { vec![markers] } else { Vec::new() };
    Ok(Box::new(Viewer {
        hub,
        interface: Interface { publications, subscriptions, ..Interface::default() },
        roles,
        follows_team: parameters.bool("follow_team")?,
        next: Steady::default(),
        marked: None,
    }))
}

struct Viewer {
    hub: &'static Hub,
    interface: Interface,
    roles: Vec<Role>,
    follows_team: bool,
    next: Steady,
    /// When markers were published.
    marked: Option<Steady>,
}

impl NodeCore for Viewer {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Message { port, cdr, .. } => {
                let Some(role) = self.roles.get(port) else { return };
                self.hub.view().take(at.ros, role, cdr);
                if *role == Role::Team && self.follows_team && self.meets() {
                    sink.exit(REJOIN);
                }
            }
            Event::Wakeup => {
                let is_watched = self.hub.is_watched();
                self.next = at.steady.plus_seconds(if is_watched { PERIOD } else { LOOK });
                self.mark(at, sink);
                if is_watched {
                    self.hub.view().advance(at.ros);
                    self.hub.publish();
                }
            }
            _ => {}
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        Some(self.next)
    }

    fn set_parameters(&mut self, _: &Parameters) -> Result<(), ConfigError> {
        Ok(())
    }
}

impl Viewer {
    /// Publishes the picture's own markers, if it is time.
    fn mark(&mut self, at: Times, sink: &mut dyn Sink) {
        let is_due = self.marked.is_none_or(|last| at.steady.seconds_since(last) >= MARKERS_PERIOD);
        if is_due && !self.interface.publications.is_empty() {
            self.marked = Some(at.steady);
            sink.publish(MARKERS, &self.hub.view().markers());
        }
    }

    /// Whether the team has robots that are not listened to yet.
    fn meets(&self) -> bool {
        let (view, mut robots) = (self.hub.view(), self.hub.robots());
        let before = robots.len();
        let is_name = |name: &&str| name.split('/').all(is_token);
        for name in view.robots().filter(is_name) {
            if robots.len() < MOST && !robots.contains(name) {
                robots.insert(name.to_owned());
            }
        }
        robots.len() > before
    }
}

/// Whether ROS allows this as a part of a topic's name.
fn is_token(text: &str) -> bool {
    let starts_well = text.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_');
    starts_well && text.chars().all(|character| character.is_ascii_alphanumeric() || character == '_')
}
