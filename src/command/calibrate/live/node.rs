//! The node that sees: an ordinary subscriber, and a client of the localizer that takes the colours over.

use super::super::apply;
use super::bench::Task;
use super::table::Table;
use std::sync::{Arc, OnceLock};
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Event, Files, Interface, NodeContext, NodeCore, NodeDescription, Qos, Serve, Sink, StartError, Steady, Subscribe,
    Times,
};
use trench_msgs::Message;
use trench_msgs::rcl_interfaces::{
    SetParametersAtomically, SetParametersAtomicallyRequest, SetParametersAtomicallyResponse,
};
use trench_msgs::sensor_msgs::{CompressedImage, Image};

/// The shortest time between two pictures, s: it looks at every pixel of them.
const PERIOD: f64 = 0.06;
/// How often it looks what the page has asked for, s.
const LOOK: f64 = 0.05;
/// How often the page hears how it stands, if nothing else happens, s.
const NEWS: f64 = 0.5;
/// Of the frames' rate, a new interval counts so much.
const FOLLOW: f64 = 0.1;

/// What the node is told, besides its table.
pub(super) struct Ears {
    pub(super) topic: String,
    pub(super) compressed: bool,
    pub(super) out: std::path::PathBuf,
    pub(super) localizer: String,
}

/// The process's one table: nodes are made by plain functions, which can be given nothing else.
static KEPT: OnceLock<(Arc<Table>, Ears)> = OnceLock::new();

/// Keeps the table for the node.
pub(super) fn keep(table: Table, ears: Ears) -> Arc<Table> {
    Arc::clone(&KEPT.get_or_init(|| (Arc::new(table), ears)).0)
}

/// Runs the node until a signal ends it; gives the exit code.
pub(super) fn run(further: &[String]) -> u8 {
    // A person looks at it: whoever drives robots goes first.
    trench_runtime::wait_turn(trench_runtime::Turn::Watcher);
    trench_runtime::run_with_arguments(description(), further.iter().cloned())
}

fn description() -> NodeDescription {
    NodeDescription {
        name: "calibrate",
        about: "Shows what the limits of the colours cover",
        parameters: Vec::new,
        build,
    }
}

fn build(_: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let (table, ears) =
        KEPT.get().ok_or_else(|| parameters.error("", "has no page to show", "start trench calibrate live"))?;
    let image = if ears.compressed { CompressedImage::TYPE } else { Image::TYPE };
    let interface = Interface {
        subscriptions: vec![Subscribe::of_type(ears.topic.clone(), image, Qos::SENSOR)],
        clients: vec![Serve::of::<SetParametersAtomically>(format!("{}/set_parameters_atomically", ears.localizer))],
        ..Interface::default()
    };
    let (next, frames) = (Steady::default(), 0);
    Ok(Box::new(Watcher { table, ears, interface, next, frames, last_frame: None, interval: 0.0, shown: None }))
}

struct Watcher {
    table: &'static Table,
    ears: &'static Ears,
    interface: Interface,
    next: Steady,
    frames: u64,
    last_frame: Option<Steady>,
    /// Between frames, s.
    interval: f64,
    shown: Option<Steady>,
}

impl Watcher {
    fn frame(&mut self, now: Steady, cdr: &[u8]) {
        self.frames += 1;
        if let Some(last) = self.last_frame.replace(now) {
            let interval = now.seconds_since(last);
            let follow = if self.interval == 0.0 { 1.0 } else { FOLLOW };
            self.interval += follow * (interval - self.interval);
        }
        let is_due = self.shown.is_none_or(|shown| now.seconds_since(shown) >= PERIOD);
        let mut bench = self.table.bench();
        if is_due && self.table.is_watched() && !bench.is_held() {
            bench.take(self.frames, cdr, self.ears.compressed);
            drop(bench);
            self.show(now);
        }
    }

    fn show(&mut self, now: Steady) {
        self.shown = Some(now);
        let mut bench = self.table.bench();
        let is_live = self.last_frame.is_some_and(|last| now.seconds_since(last) < 1.0) && self.interval > 0.0;
        bench.told_rate(if is_live { 1.0 / self.interval } else { 0.0 });
        self.table.publish(bench.message());
    }

    fn serve(&mut self, now: Steady, sink: &mut dyn Sink) {
        let asked = self.table.asked();
        let is_news = !asked.is_empty();
        for command in asked {
            let task = self.table.bench().obey(command);
            match task {
                Some(Task::Save(text)) => self.save(&text),
                Some(Task::Apply(text)) => self.apply(&text, sink),
                None => {}
            }
        }
        let is_old = self.shown.is_none_or(|shown| now.seconds_since(shown) >= NEWS);
        if is_news || (is_old && self.table.is_watched()) {
            self.show(now);
        }
    }

    fn save(&self, text: &str) {
        let path = self.ears.out.display();
        match std::fs::write(&self.ears.out, text) {
            Ok(()) => self.table.bench().tell("good", &format!("wrote {path}")),
            Err(error) => self.table.bench().tell("bad", &format!("{path}: {error}")),
        }
    }

    fn apply(&self, text: &str, sink: &mut dyn Sink) {
        match apply::values("the page", text, &self.ears.localizer) {
            Ok(parameters) => {
                sink.call(0, &SetParametersAtomicallyRequest { parameters });
                self.table.bench().tell("", &format!("asked {}", self.ears.localizer));
            }
            Err(error) => self.table.bench().tell("bad", &error.to_string()),
        }
    }

    fn answered(&self, cdr: Option<&[u8]>) {
        let localizer = &self.ears.localizer;
        let result = cdr.and_then(|cdr| SetParametersAtomicallyResponse::decode(cdr).ok()).map(|answer| answer.result);
        let mut bench = self.table.bench();
        match result {
            Some(result) if result.successful => bench.tell("good", &format!("in force at {localizer}")),
            Some(result) => bench.tell("bad", &format!("{localizer} refused: {}", result.reason)),
            None => bench.tell("bad", &format!("{localizer} does not answer: is it running, in this ROS_DOMAIN_ID?")),
        }
    }
}

impl NodeCore for Watcher {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Message { cdr, .. } => self.frame(at.steady, cdr),
            Event::Response { cdr, .. } => {
                self.answered(cdr);
                self.show(at.steady);
            }
            Event::Wakeup => {
                self.next = at.steady.plus_seconds(LOOK);
                self.serve(at.steady, sink);
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
