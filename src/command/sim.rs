//! `trench sim`: drives the node cores of a launch file in lock-step, without processes.

use super::launch::name_and_value;
use super::say;
use clap::Parser;
use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;
use trench_bag::run::{RunBuilder, SummaryOptions, summary};
use trench_bag::{BagError, BagWriter, Stamp, TopicId, TopicType, WriteOptions};
use trench_core::{Advertise, Level, Source, Times};
use trench_harness::{BusError, Disk, Ending, LoadError, Lockstep, Observer, load_journalled, plan};
use trench_journal::{Journals, Pace};

const EXIT_CODES: &str = "\
Exit codes:
  0   the operator's verdict: the formation stands (or no operator took part)
  n   the exit code of the node that ended the run
  1   the run did not end within --seconds
  2   the launch file, the arguments or a node's configuration is wrong";

/// Drives the node cores of a launch file in lock-step, faster than real time.
///
/// The same files that `trench launch` starts as processes. Two runs are equal byte for byte. Unless the launch file is
/// told otherwise (render:=true), cameras give the discs a detector would find instead of pixels.
#[derive(Parser)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct Arguments {
    /// The launch file, for example launch/square.launch.yaml.
    file: PathBuf,
    /// Arguments of the launch file.
    #[arg(value_name = "NAME:=VALUE", value_parser = name_and_value)]
    arguments: Vec<(String, String)>,
    /// Simulated seconds after which the run is given up.
    #[arg(long, default_value_t = 600.0)]
    seconds: f64,
    /// Seed of what must differ between runs of a node.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Records all messages into a bag in this folder, which must not exist.
    #[arg(long, value_name = "FOLDER")]
    bag: Option<PathBuf>,
    /// Keeps a journal of every node in this folder, which must not exist, for trench bag check.
    #[arg(long, value_name = "FOLDER")]
    journal: Option<PathBuf>,
    /// Keeps the camera images that nodes read in their journals too (1.3 MB each).
    #[arg(long, requires = "journal")]
    journal_images: bool,
    /// Writes where each robot was and should have been into this file (CSV).
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Prints the summary as JSON.
    #[arg(long)]
    json: bool,
    /// Prints warnings and errors of the nodes alone.
    #[arg(long, short)]
    quiet: bool,
}

#[derive(Debug, thiserror::Error)]
enum SimError {
    #[error(transparent)]
    Config(#[from] trench_config::ConfigError),
    #[error(transparent)]
    Load(#[from] LoadError),
    #[error(transparent)]
    Bus(#[from] BusError),
    #[error(transparent)]
    Bag(#[from] BagError),
    #[error("{0} exists already; give the journals another folder or remove it")]
    JournalsExist(String),
    #[error("{path}: {error}", path = path.display())]
    Write { path: PathBuf, error: std::io::Error },
}

/// Runs the subcommand.
pub(crate) fn run(arguments: &Arguments) -> ExitCode {
    match simulate(arguments) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("trench sim: {error}");
            ExitCode::from(2)
        }
    }
}

fn simulate(arguments: &Arguments) -> Result<u8, SimError> {
    let plan = plan(&arguments.file, &arguments.arguments.iter().cloned().collect())?;
    if let Some(folder) = arguments.journal.as_ref().filter(|folder| folder.exists()) {
        return Err(SimError::JournalsExist(folder.display().to_string()));
    }
    let folder = arguments.journal.clone();
    let journals = folder.map(|folder| Journals { folder, images: arguments.journal_images, pace: Pace::LockStep });
    let loaded = load_journalled(&plan, &Disk, arguments.seed, journals.as_ref())?;
    for label in &loaded.left_out {
        eprintln!("trench sim: {label} is no node of ours and is left out");
    }
    let mut lockstep = Lockstep::new(loaded.instances)?;
    let bag = arguments.bag.as_deref().map(|folder| BagWriter::create(folder, WriteOptions::default())).transpose()?;
    let mut watch =
        Watch { builder: RunBuilder::default(), bag, topics: BTreeMap::new(), error: None, quiet: arguments.quiet };
    let (began, from) = (Instant::now(), lockstep.times().steady);
    let ending = lockstep.run(arguments.seconds, &mut watch);
    let (took, simulated) = (began.elapsed().as_secs_f64(), lockstep.times().steady.seconds_since(from));
    watch.finish_bag()?;
    let run = watch.builder.finish();
    if let Some(path) = &arguments.csv {
        let text = run.to_csv();
        fs::write(path, text).map_err(|error| SimError::Write { path: path.clone(), error })?;
    }
    let summary = summary(&run, &SummaryOptions::default());
    if arguments.json {
        say(format_args!("{:#}\n", serde_json::json!(summary)));
    } else {
        say(summary);
    }
    let mut console = std::io::stderr();
    // A closed console is no reason to fail a run.
    let _ = writeln!(console, "{simulated:.1} s simulated in {took:.2} s: {:.0} times real time", simulated / took);
    Ok(match ending {
        Ending::Exit { code, .. } => code,
        Ending::Silence => 0,
        Ending::TimeOver => 1,
    })
}

/// Shows, judges and records what happens.
struct Watch {
    builder: RunBuilder,
    bag: Option<BagWriter>,
    topics: BTreeMap<String, TopicId>,
    error: Option<BagError>,
    quiet: bool,
}

impl Watch {
    fn record(
        &mut self,
        at: Times,
        topic: &str,
        advertise: &Advertise,
        source: Source,
        cdr: &[u8],
    ) -> Result<(), BagError> {
        let Some(bag) = &mut self.bag else { return Ok(()) };
        let id = match self.topics.get(topic) {
            Some(&id) => id,
            None => {
                let id = bag.add_topic(topic, TopicType::from(advertise.type_info), advertise.qos)?;
                self.topics.insert(topic.to_owned(), id);
                id
            }
        };
        let nanoseconds = u64::try_from(at.ros.0).unwrap_or(0);
        let stamp = Stamp { log_time: nanoseconds, publish_time: nanoseconds, sequence: source.sequence as u32 };
        bag.write(id, stamp, cdr)
    }

    fn finish_bag(&mut self) -> Result<(), BagError> {
        match (self.error.take(), self.bag.take()) {
            (Some(error), _) => Err(error),
            (None, Some(bag)) => bag.finish(),
            (None, None) => Ok(()),
        }
    }
}

impl Observer for Watch {
    fn published(&mut self, at: Times, topic: &str, advertise: &Advertise, source: Source, cdr: &[u8]) {
        self.builder.take(topic, advertise.type_info.name, cdr);
        if self.error.is_none() {
            self.error = self.record(at, topic, advertise, source, cdr).err();
        }
    }

    fn logged(&mut self, at: Times, node: &str, level: Level, text: &str) {
        if level >= Level::Warn || (!self.quiet && level >= Level::Info) {
            eprintln!("[{:9.3}] {node}: {text}", at.steady.0 as f64 * 1e-9);
        }
    }
}
