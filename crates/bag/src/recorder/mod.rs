//! The recorder: a node that writes what it hears into a bag.
//!
//! It is a node core like any other, so that it runs in a process of its own on whatever transports the process has;
//! unlike the cores of robots it writes files: that is its output.

mod batch;
mod discovery;
mod topics;

use crate::selection::{self, Selection};
use crate::{BagError, BagWriter, Compression, Stamp, TopicId, WriteOptions};
use batch::Batch;
use std::path::Path;
use std::time::Duration;
use topics::subscription;
use trench_config::params::USE_SIM_TIME;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::{
    Advertise, Condition, Discovered, Durability, Event, Files, Health, Interface, Level, Local, NodeContext, NodeCore,
    NodeDescription, Qos, Sink, StartError, Steady, Subscribe, Times, resolve_name,
};
use trench_msgs::diagnostic_msgs::DiagnosticArray;

/// How often what was heard is written, s. A recorder that woke for each of a thousand messages a second would take several
/// per cent of a core; images, which are few and large, wake it.
const BATCH: f64 = 0.05;
/// The largest file to ask for, bytes.
const MOST: f64 = 1e15;
/// The publication of /diagnostics.
const DIAGNOSTICS: usize = 0;
/// The exit code when a recording ended early.
const FAILED: u8 = 1;

/// The recorder as processes make it.
#[must_use]
pub fn description() -> NodeDescription {
    NodeDescription {
        name: "bag_recorder",
        about: "Records topics into a bag (MCAP as rosbag2 writes it) until it is stopped.",
        parameters,
        build,
    }
}

fn parameters() -> Vec<ParameterDescriptor> {
    let mut descriptors = vec![
        ParameterDescriptor::string("output", "", "the new bag's folder, which must not exist").read_only(),
        ParameterDescriptor::string_list(
            "topics",
            &[],
            "topics to record, NAME or NAME:TYPE (the type where it is to be heard before anybody writes it); without \
             any and without `regex`, all that are written, images excepted",
        )
        .read_only(),
        ParameterDescriptor::string_list("robots", &[], "robots whose topics are heard before anybody writes them")
            .read_only(),
        ParameterDescriptor::bool("all", false, "whether images are recorded too").read_only(),
        ParameterDescriptor::integer(
            "max_bag_size",
            0,
            "the next file begins before one is larger than this, bytes; 0: never",
        )
        .range(0.0, MOST)
        .read_only(),
        ParameterDescriptor::double(
            "max_bag_duration",
            0.0,
            "the next file begins when one spans this long, s; 0: never",
        )
        .range(0.0, 1e9)
        .read_only(),
    ];
    descriptors.extend(selection::parameters());
    descriptors
}

fn build(context: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let output = parameters.str("output")?;
    if output.is_empty() {
        return Err(parameters.error("output", "is empty", "name the new bag's folder").into());
    }
    let asked = parameters.str_list("topics")?;
    let names = asked.iter().map(|asked| topics::name(asked).to_owned()).collect();
    let selection = Selection::new(names, parameters)?;
    let usual = topics::usual(parameters.str_list("robots")?);
    let beforehand = if selection.is_narrow() { asked } else { &usual };
    let subscriptions: Result<Vec<_>, _> = beforehand.iter().map(|name| subscription(name)).collect();
    let subscriptions = subscriptions.map_err(|(problem, remedy)| parameters.error("topics", problem, remedy))?;
    let chosen = subscriptions.into_iter().flatten().filter(|subscribe| selection.takes(&subscribe.topic));
    let subscriptions: Vec<_> = chosen.map(without_waking).collect();
    let writer = BagWriter::create(Path::new(output), options(parameters, &subscriptions)?)
        .map_err(|error| parameters.error("output", error.to_string(), "name a new folder on a disk with space"))?;
    Ok(Box::new(Recorder {
        ids: vec![None; subscriptions.len()],
        interface: Interface { subscriptions, publications: vec![diagnostics()], ..Interface::default() },
        health: Health::new(resolve_name("~", &context.namespace, &context.name)),
        selection,
        images: parameters.bool("all")?,
        notes: Vec::new(),
        batch: Batch::default(),
        simulated: parameters.bool(USE_SIM_TIME)?,
        writer: Some(writer),
        next_look: Steady::default(),
    }))
}

/// Messages of a topic that may come before the next batch is written: eight seconds of poses, should the recorder be kept from its
/// work so long.
const DEPTH: usize = 256;

/// Small messages wait for the next batch.
fn without_waking(subscribe: Subscribe) -> Subscribe {
    let qos = match subscribe.qos.durability {
        Durability::TransientLocal => subscribe.qos,
        Durability::Volatile => Qos { depth: subscribe.qos.depth.max(DEPTH), ..subscribe.qos },
    };
    if discovery::is_image(subscribe.type_info.name) {
        subscribe
    } else {
        Subscribe { qos, ..subscribe }.without_waking()
    }
}

fn options(parameters: &Parameters, heard: &[Subscribe]) -> Result<WriteOptions, ConfigError> {
    let bytes = u64::try_from(parameters.i64("max_bag_size")?).unwrap_or(0);
    let seconds = parameters.f64("max_bag_duration")?;
    let is_image = |subscribe: &Subscribe| discovery::is_image(subscribe.type_info.name);
    let has_images = parameters.bool("all")? || heard.iter().any(is_image);
    Ok(WriteOptions {
        compression: if has_images { Compression::Off } else { Compression::Zstd },
        split_bytes: (bytes > 0).then_some(bytes),
        split_after: (seconds > 0.0).then(|| Duration::from_secs_f64(seconds)),
        ..WriteOptions::default()
    })
}

/// Where the recorder says why it ends, and nothing before: what is recorded is what the run says.
fn diagnostics() -> Advertise {
    Advertise::of::<DiagnosticArray>("/diagnostics", Qos::RELIABLE, Local::NetworkOnly)
}

struct Recorder {
    interface: Interface,
    health: Health,
    /// The bag's topic of each subscription, once it was heard.
    ids: Vec<Option<TopicId>>,
    selection: Selection,
    /// Whether images are recorded although nobody named them.
    images: bool,
    /// What is to be told about topics that were discovered.
    notes: Vec<(Level, String)>,
    batch: Batch,
    /// Whether ROS time is /clock, which stands between its messages.
    simulated: bool,
    /// Nothing once the bag is finished.
    writer: Option<BagWriter>,
    next_look: Steady,
}

impl NodeCore for Recorder {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        for (level, text) in std::mem::take(&mut self.notes) {
            sink.log(level, &text);
        }
        let done = match event {
            Event::Started => {
                let count = self.interface.subscriptions.len();
                sink.log(Level::Info, &format!("listening to {count} topics, and to those that are discovered"));
                self.look(at)
            }
            Event::Message { port, source, cdr, arrived } => {
                // 32 bits is what the format has; a count beyond them starts again.
                let sequence = (source.sequence & u64::from(u32::MAX)) as u32;
                let time = self.log_time(at, arrived);
                if self.interface.subscriptions.get(port).is_some_and(|heard| heard.wakes) {
                    self.write_batch().and_then(|()| self.write(port, stamp(time, sequence), cdr))
                } else {
                    self.batch.keep(port, time, sequence, cdr);
                    Ok(())
                }
            }
            Event::Wakeup => self.write_batch().and_then(|()| self.look(at)),
            Event::Shutdown => {
                let done = self.write_batch();
                if done.is_ok() {
                    return self.finish(sink, true);
                }
                done
            }
            _ => Ok(()),
        };
        if let Err(error) = done {
            sink.log(Level::Fatal, &error.to_string());
            // Before what may take long on such a disk.
            self.health.set("recording", Condition::Error, error.to_string());
            self.health.publish(at, DIAGNOSTICS, sink);
            self.finish(sink, false);
            sink.exit(FAILED);
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        self.writer.is_some().then_some(self.next_look)
    }

    fn discovered(&mut self, found: Discovered<'_>) -> Option<Subscribe> {
        let is_image = !self.selection.is_narrow() && !self.images && discovery::is_image(found.type_name);
        let is_known = self.interface.subscriptions.iter().any(|subscribe| subscribe.topic == found.topic);
        let is_hidden = found.topic.split('/').any(|part| part.starts_with('_'));
        if is_known || is_image || is_hidden || self.writer.is_none() || !self.selection.takes(found.topic) {
            return None;
        }
        let (type_info, note) = discovery::type_info(&found);
        self.notes.push((Level::Debug, format!("{} of type {} is recorded too", found.topic, found.type_name)));
        self.notes.extend(note.map(|note| (Level::Warn, note)));
        let subscribe = without_waking(Subscribe::of_type(found.topic, type_info, discovery::qos(&found)));
        self.interface.subscriptions.push(subscribe.clone());
        self.ids.push(None);
        Some(subscribe)
    }

    fn set_parameters(&mut self, _: &Parameters) -> Result<(), ConfigError> {
        Ok(())
    }
}

/// Recorded at `time`, which is as near as it is known to when it was published.
fn stamp(time: u64, sequence: u32) -> Stamp {
    Stamp { log_time: time, publish_time: time, sequence }
}

impl Recorder {
    /// ROS time when a message arrived, ns.
    fn log_time(&self, at: Times, arrived: Option<Steady>) -> u64 {
        let arrived = arrived.filter(|_| !self.simulated).unwrap_or(at.steady);
        let age = at.steady.0.saturating_sub(arrived.0);
        // Time before the epoch is none: a clock that has not started yet.
        u64::try_from(at.ros.0).unwrap_or(0).saturating_sub(age)
    }

    fn write_batch(&mut self) -> Result<(), BagError> {
        let mut batch = std::mem::take(&mut self.batch);
        let done = batch.write(|heard, cdr| self.write(heard.port, stamp(heard.time, heard.sequence), cdr));
        // Its memory is used again.
        self.batch = batch;
        done
    }

    fn write(&mut self, port: usize, stamp: Stamp, cdr: &[u8]) -> Result<(), BagError> {
        let (Some(writer), Some(heard), Some(id)) =
            (&mut self.writer, self.interface.subscriptions.get(port), self.ids.get_mut(port))
        else {
            return Ok(());
        };
        let topic = match *id {
            Some(topic) => topic,
            None => *id.insert(writer.add_topic(&heard.topic, heard.type_info.into(), heard.qos)?),
        };
        writer.write(topic, stamp, cdr)
    }

    fn look(&mut self, at: Times) -> Result<(), BagError> {
        self.next_look = at.steady.plus_seconds(BATCH);
        self.writer.as_mut().map_or(Ok(()), BagWriter::flush_if_due)
    }

    fn finish(&mut self, sink: &mut dyn Sink, is_asked: bool) {
        let Some(writer) = self.writer.take() else { return };
        let count = writer.message_count();
        match writer.finish() {
            Ok(()) => sink.log(Level::Info, &format!("recorded {count} messages")),
            Err(error) => {
                sink.log(Level::Error, &format!("the bag has no index: {error}"));
                if is_asked {
                    sink.exit(FAILED);
                }
            }
        }
    }
}
