//! Bridge and test bed with their bytes connected in memory, driven by their wakeups.
#![expect(clippy::unwrap_used, clippy::panic, reason = "a test ends where what it needs is missing")]

use trench_config::{ConfigError, Origin, ParameterValue, Parameters};
use trench_core::{
    Action, Event, Files, Level, NodeContext, NodeCore, NodeDescription, Outbox, RequestId, RosTime, Source, Steady,
    Times,
};
use trench_msgs::geometry_msgs::TwistStamped;
use trench_msgs::msg::RunState;
use trench_msgs::std_msgs::Bool;
use trench_msgs::std_srvs::TriggerResponse;
use trench_msgs::{Encode, Message};

pub(crate) const MS: u64 = 1_000_000;

/// The wall clock at monotonic time 0.
pub(crate) const EPOCH: i64 = 1_577_836_800_000_000_000;

/// Files by name.
pub(crate) struct Texts(pub(crate) Vec<(&'static str, &'static str)>);

impl Files for Texts {
    fn read(&self, key: &str, path: &str) -> Result<String, ConfigError> {
        let text = self.0.iter().find(|(name, _)| *name == path).map(|(_, text)| (*text).to_owned());
        text.ok_or_else(|| Parameters::default().error(key, "cannot be read", "write a file that is there"))
    }
}

/// A node's parameters: its defaults and these.
pub(crate) fn parameters(description: &NodeDescription, given: &[(&str, ParameterValue)]) -> Parameters {
    let mut parameters = Parameters::default();
    for declared in (description.parameters)() {
        parameters.insert(declared.name, declared.default.clone(), Origin::default());
    }
    for (name, value) in given {
        assert!(parameters.get(name).is_some(), "{name} is not declared");
        parameters.insert(*name, value.clone(), Origin::default());
    }
    parameters
}

pub(crate) fn strings(values: &[&str]) -> ParameterValue {
    ParameterValue::StringArray(values.iter().map(|value| (*value).to_owned()).collect())
}

/// One core with what it put out.
pub(crate) struct Node {
    pub(crate) core: Box<dyn NodeCore>,
    pub(crate) outbox: Outbox,
}

impl Node {
    pub(crate) fn new(description: &NodeDescription, given: &[(&str, ParameterValue)], files: &Texts) -> Self {
        let parameters = parameters(description, given);
        let context =
            NodeContext { namespace: "/".to_owned(), name: description.name.to_owned(), ..NodeContext::default() };
        let core = (description.build)(&context, &parameters, files).unwrap_or_else(|error| panic!("{error}"));
        Self { core, outbox: Outbox::default() }
    }

    /// The port of a topic that is published.
    pub(crate) fn port(&self, topic: &str) -> usize {
        self.core.interface().publications.iter().position(|p| p.topic == topic).unwrap_or_else(|| panic!("{topic}"))
    }

    /// All messages published on a topic so far.
    pub(crate) fn published<M: Message>(&self, topic: &str) -> Vec<M> {
        self.outbox.published(self.port(topic))
    }

    pub(crate) fn last<M: Message>(&self, topic: &str) -> M {
        self.published(topic).pop().unwrap_or_else(|| panic!("nothing on {topic}"))
    }
}

/// Bridge and test bed.
pub(crate) struct Loop {
    pub(crate) bridge: Node,
    pub(crate) testbed: Node,
    pub(crate) now: u64,
    /// Bytes that went down the line, with the times.
    pub(crate) down: Vec<(u64, Vec<u8>)>,
    /// Whether bytes pass the line.
    pub(crate) is_connected: bool,
    sequence: u64,
}

impl Loop {
    /// Robots at `poses` (x, y and heading each), with further parameters of bridge and test bed. Opens the line.
    pub(crate) fn new(
        poses: &[f64],
        bridge: &[(&str, ParameterValue)],
        testbed: &[(&str, ParameterValue)],
        files: &Texts,
    ) -> Self {
        let names: Vec<String> = (1..=poses.len() / 3).map(|number| format!("robot{number}")).collect();
        let robots = ("robots", ParameterValue::StringArray(names));
        let text = |text: &str| ParameterValue::String(text.to_owned());
        let mut of_bridge = vec![robots.clone(), ("serial.port", text("line"))];
        of_bridge.extend(bridge.iter().cloned());
        let mut of_testbed = vec![
            robots,
            ("serial.link", text("line")),
            ("poses", ParameterValue::DoubleArray(poses.to_vec())),
            ("render", ParameterValue::Bool(false)),
        ];
        of_testbed.extend(testbed.iter().cloned());
        let mut this = Self {
            bridge: Node::new(&rf_bridge::description(), &of_bridge, files),
            testbed: Node::new(&testbed::description(), &of_testbed, files),
            now: 1_000 * MS,
            down: Vec::new(),
            is_connected: true,
            sequence: 0,
        };
        this.tell_testbed(Event::Started);
        this.start_bridge();
        this
    }

    /// The bridge begins its life with an open line.
    pub(crate) fn start_bridge(&mut self) {
        self.tell_bridge(Event::Started);
        self.plug(true);
    }

    pub(crate) fn times(&self) -> Times {
        Times { ros: RosTime(EPOCH + self.now as i64), steady: Steady(self.now) }
    }

    fn tell_bridge(&mut self, event: Event<'_>) {
        let (at, before) = (self.times(), self.bridge.outbox.actions.len());
        self.bridge.core.handle(at, event, &mut self.bridge.outbox);
        let written: Vec<Vec<u8>> = self.bridge.outbox.actions[before..].iter().filter_map(bytes).collect();
        for bytes in written {
            self.down.push((self.now, bytes.clone()));
            if self.is_connected {
                self.tell_testbed(Event::Bytes { stream: 0, data: &bytes });
            }
        }
    }

    fn tell_testbed(&mut self, event: Event<'_>) {
        let (at, before) = (self.times(), self.testbed.outbox.actions.len());
        self.testbed.core.handle(at, event, &mut self.testbed.outbox);
        if !self.is_connected {
            return;
        }
        let written: Vec<Vec<u8>> = self.testbed.outbox.actions[before..].iter().filter_map(bytes).collect();
        for bytes in written {
            self.tell_bridge(Event::Bytes { stream: 0, data: &bytes });
        }
    }

    /// Lets time go on by `milliseconds`, waking both cores when they want it.
    pub(crate) fn run(&mut self, milliseconds: u64) {
        let end = self.now + milliseconds * MS;
        loop {
            let bridge = self.bridge.core.next_wakeup().map_or(u64::MAX, |at| at.0.max(self.now));
            let testbed = self.testbed.core.next_wakeup().map_or(u64::MAX, |at| at.0.max(self.now));
            let next = bridge.min(testbed);
            if next > end {
                break;
            }
            self.now = next;
            if testbed == next {
                self.tell_testbed(Event::Wakeup);
            }
            if bridge == next {
                self.tell_bridge(Event::Wakeup);
            }
        }
        self.now = end;
        self.tell_testbed(Event::Wakeup);
    }

    /// Lets time go on for the test bed alone: the bridge is held up, and hears afterwards what came meanwhile.
    pub(crate) fn run_without_bridge(&mut self, milliseconds: u64) {
        let end = self.now + milliseconds * MS;
        let before = self.testbed.outbox.actions.len();
        while let Some(at) = self.testbed.core.next_wakeup().map(|at| at.0.max(self.now)).filter(|at| *at <= end) {
            self.now = at;
            let times = self.times();
            self.testbed.core.handle(times, Event::Wakeup, &mut self.testbed.outbox);
        }
        self.now = end;
        let written: Vec<u8> = self.testbed.outbox.actions[before..].iter().filter_map(bytes).flatten().collect();
        self.noise_up(&written);
    }

    /// A publisher comes, or has gone.
    pub(crate) fn presence(&mut self, topic: &str, publisher: u8, is_there: bool) {
        let port = self.port_of(topic);
        self.tell_bridge(Event::Presence { port, gid: [publisher; 16], is_there });
    }

    /// A message to the bridge, from the publisher with this number.
    pub(crate) fn publish(&mut self, topic: &str, publisher: u8, message: &dyn Encode) {
        let port = self.port_of(topic);
        self.sequence += 1;
        let source = Source { gid: [publisher; 16], sequence: self.sequence };
        self.tell_bridge(Event::Message { port, source, cdr: &message.to_cdr(), arrived: None });
    }

    fn port_of(&self, topic: &str) -> usize {
        let subscriptions = &self.bridge.core.interface().subscriptions;
        subscriptions.iter().position(|s| s.topic == topic).unwrap_or_else(|| panic!("{topic}"))
    }

    pub(crate) fn run_state(&mut self, state: u8) {
        self.publish("/run_state", 1, &RunState { state, ..RunState::default() });
    }

    pub(crate) fn emergency_stop(&mut self, publisher: u8, stop: bool) {
        self.publish("/emergency_stop", publisher, &Bool { data: stop });
    }

    /// The same command for robots 1 to `count`, resting on an exposure `age_ms` ago.
    pub(crate) fn command(&mut self, count: usize, v: f64, omega: f64, age_ms: u64) {
        (1..=count).for_each(|robot| self.command_to(robot, v, omega, age_ms));
    }

    /// The same for one robot.
    pub(crate) fn command_to(&mut self, robot: usize, v: f64, omega: f64, age_ms: u64) {
        let mut command = TwistStamped::default();
        command.header.stamp = RosTime(EPOCH + self.now as i64 - (age_ms * MS) as i64).into();
        (command.twist.linear.x, command.twist.angular.z) = (v, omega);
        self.publish(&format!("/robot{robot}/cmd_vel"), robot as u8, &command);
    }

    /// Commands at 30 Hz for so many camera frames.
    pub(crate) fn drive(&mut self, frames: u64, count: usize, v: f64, omega: f64) {
        for frame in 0..frames {
            self.command(count, v, omega, 40);
            self.run(33 + frame % 2);
        }
    }

    pub(crate) fn reset(&mut self) -> TriggerResponse {
        let before = self.bridge.outbox.actions.len();
        self.tell_bridge(Event::Request { service: 0, id: RequestId(1), cdr: &[] });
        let responses = self.bridge.outbox.actions[before..].iter().filter_map(|action| match action {
            Action::Respond { cdr, .. } => TriggerResponse::decode(cdr).ok(),
            _ => None,
        });
        responses.collect::<Vec<_>>().pop().unwrap()
    }

    /// The line breaks, or is there again.
    pub(crate) fn plug(&mut self, open: bool) {
        self.tell_bridge(Event::StreamState { stream: 0, open });
    }

    /// The bridge hears these bytes from the line.
    pub(crate) fn noise_up(&mut self, bytes: &[u8]) {
        self.tell_bridge(Event::Bytes { stream: 0, data: bytes });
    }

    /// The bridge hears once more what the base station wrote since this one of the test bed's actions, if that ends with a frame;
    /// gives how many frames that was.
    pub(crate) fn repeat(&mut self, since: usize) -> usize {
        let written: Vec<u8> = self.testbed.outbox.actions[since..].iter().filter_map(bytes).flatten().collect();
        if written.last() != Some(&0) {
            return 0;
        }
        self.noise_up(&written);
        written.iter().filter(|byte| **byte == 0).count()
    }

    /// The base station hears these bytes from the line.
    pub(crate) fn noise_down(&mut self, bytes: &[u8]) {
        self.tell_testbed(Event::Bytes { stream: 0, data: bytes });
    }

    /// The true track of a robot: time (ms), x, y, speed.
    pub(crate) fn track(&self, robot: usize) -> Vec<(f64, f64, f64, f64)> {
        let odometry: Vec<trench_msgs::nav_msgs::Odometry> =
            self.testbed.published(&format!("/ground_truth/robot{robot}/odom"));
        odometry
            .iter()
            .map(|message| {
                let position = &message.pose.pose.position;
                let at = RosTime::from(&message.header.stamp).0 - EPOCH;
                (at as f64 * 1e-6, position.x, position.y, message.twist.twist.linear.x)
            })
            .collect()
    }

    /// Where a robot was when the last frame was exposed.
    pub(crate) fn place(&self, robot: usize) -> (f64, f64) {
        self.track(robot).last().map(|(_, x, y, _)| (*x, *y)).unwrap()
    }

    pub(crate) fn logged(&self, level: Level) -> usize {
        let of_level = |action: &&Action| matches!(action, Action::Log { level: logged, .. } if *logged == level);
        self.bridge.outbox.actions.iter().filter(of_level).count()
    }
}

fn bytes(action: &Action) -> Option<Vec<u8>> {
    match action {
        Action::Write { bytes, .. } => Some(bytes.clone()),
        _ => None,
    }
}
