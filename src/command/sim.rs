//! `trench sim`: drives the node cores of a launch file in lock-step, or runs a scenario file, without processes.

mod progress;
pub(super) mod scenario;
mod sink;
mod threads;

use super::launch::name_and_value;
use super::{named, say};
use clap::Parser;
use progress::Progress;
use sink::Sink;
use std::fs;
use std::io::Write;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;
use trench_bag::BagError;
use trench_bag::run::{Run, SummaryOptions, summary};
use trench_core::{Advertise, Files, Level, Qos, Source, Steady, Times};
use trench_harness::{BusError, Disk, Ending, LoadError, Lockstep, Observer, load_journalled, plan};
use trench_journal::{Journals, Pace};
use trench_scenario::{RunError, Scenario, Task};

/// Of `--seconds`.
const LONGEST: f64 = 600.0;

/// Of `--seed`.
const SEED: u64 = 1;

const EXIT_CODES: &str = "\
Exit codes:
  0   the operator's verdict: the formation stands (or no operator took part)
  n   the exit code of the node that ended the run
  1   the run did not end within --seconds
  2   the scenario, the launch file, the arguments or a node's configuration is wrong
  10  the formation does not stand; of a scenario: the run diverged, or a robot went through an obstacle
Scenarios end with 0, 2 or 10.";

/// Of a scenario whose run no robots can make: it diverged, or they went through obstacles; the operator's, if the formation does not stand.
const FAILED: u8 = 10;

/// Runs a scenario file headless, or drives the node cores of a launch file in lock-step, faster than real time.
///
/// Scenario files (config/scenarios, docs/scenarios.md) are the simulations of the theory, launch files those that `trench launch` starts as
/// processes; which of the two a file is, is told by its content. Two runs are equal byte for byte. In runs of launch files cameras give the
/// discs a detector would find instead of pixels, unless the file is told otherwise (render:=true).
#[derive(Parser, Clone)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct Arguments {
    /// The scenario, for example config/scenarios/7.10.yaml, or the launch file, for example launch/square.launch.yaml.
    file: PathBuf,
    /// Arguments of the launch file.
    #[arg(value_name = "NAME:=VALUE", value_parser = name_and_value)]
    arguments: Vec<(String, String)>,
    /// Simulated seconds after which the run of a launch file is given up; 600 where nothing is said.
    #[arg(long)]
    seconds: Option<f64>,
    /// Seed of what must differ between runs of a node; 1 where nothing is said.
    #[arg(long)]
    seed: Option<u64>,
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
    /// Threads that step the robots of a chain (kind: nearest_points); worth it from some thousand robots on. The bytes are the same.
    #[arg(long, value_name = "N", default_value_t = NonZeroUsize::MIN)]
    threads: NonZeroUsize,
    /// Prints warnings and errors of the nodes alone, and not how far it is.
    #[arg(long, short)]
    quiet: bool,
}

/// What ends a simulation.
#[derive(Debug, thiserror::Error)]
pub(in crate::command) enum SimError {
    #[error(transparent)]
    Config(#[from] trench_config::ConfigError),
    #[error(transparent)]
    Load(#[from] LoadError),
    #[error(transparent)]
    Bus(#[from] BusError),
    #[error(transparent)]
    Bag(#[from] BagError),
    #[error(transparent)]
    Run(#[from] RunError),
    #[error("{path}: {error}", path = path.display())]
    RunOf { path: PathBuf, error: RunError },
    #[error("{path}: is a scenario without a launch file, for which {ignored} would do nothing; leave it out: {remedy}", path = path.display())]
    Ignored { path: PathBuf, ignored: String, remedy: &'static str },
    #[error("{0} exists already; give the journals another folder or remove it")]
    JournalsExist(String),
    #[error("{path}: {error}", path = path.display())]
    Io { path: PathBuf, error: std::io::Error },
}

impl SimError {
    /// The error about a run, told with the file that it is of.
    pub(in crate::command) fn of_run(self, path: &Path) -> Self {
        match self {
            Self::Run(error) => Self::RunOf { path: path.to_owned(), error },
            other => other,
        }
    }

    fn exit_code(&self) -> u8 {
        match self {
            Self::Run(RunError::Diverged { .. }) | Self::RunOf { error: RunError::Diverged { .. }, .. } => FAILED,
            _ => 2,
        }
    }

    /// The error about a launch file, told where the scenario names it.
    fn of_scenario(self, launch: &trench_scenario::Launch) -> Self {
        match self {
            Self::Config(error) => Self::Config(launch.blamed(error)),
            Self::Load(error) => Self::Config(named::refused(launch, &error)),
            other => other,
        }
    }
}

/// Runs the subcommand.
pub(crate) fn run(arguments: &Arguments) -> ExitCode {
    match simulate(arguments) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("trench sim: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn simulate(arguments: &Arguments) -> Result<u8, SimError> {
    let Some((scenario, text)) = read(&arguments.file)? else { return drive(arguments, None) };
    if let Task::Launch(launch) = &scenario.task {
        let file = arguments.file.parent().unwrap_or(Path::new("")).join(&launch.file);
        let launch = launch.overridden_by(&arguments.arguments);
        let all = launch.pairs().into_iter().chain(arguments.arguments.iter().cloned()).collect();
        let driven = drive(&Arguments { file, arguments: all, ..arguments.clone() }, Some(&text));
        return driven.map_err(|error| error.of_scenario(&launch));
    }
    refuse_ignored(arguments)?;
    let bag = arguments.bag.as_deref();
    let manner = scenario::Manner { bag, progress: !arguments.quiet, threads: arguments.threads.get() };
    let infeasible = trench_check::infeasible(&arguments.file.display().to_string(), &scenario);
    for verdict in &infeasible {
        eprintln!("{}: {}: {} ({})", arguments.file.display(), verdict.check, verdict.finding, verdict.equation);
    }
    let done = scenario::run(&scenario, &text, manner).map_err(|error| error.of_run(&arguments.file))?;
    write_csv(arguments, &done.run)?;
    scenario::tell(&done.summary, &infeasible, arguments.json);
    let collision = done.summary.first_collision();
    // The text says so itself; who has it read by a program sees it all the same.
    if let Some(collision) = collision.filter(|_| arguments.json) {
        eprintln!("{}: collided: {collision}", arguments.file.display());
    }
    Ok(if done.summary.diverged.is_some() || collision.is_some() { FAILED } else { 0 })
}

/// What is said on the command line is done, or refused: a scenario has neither nodes, nor arguments, and says itself how long it takes.
fn refuse_ignored(arguments: &Arguments) -> Result<(), SimError> {
    let argument = arguments.arguments.first().map(|(name, value)| format!("{name}:={value}"));
    let given = [
        (argument, "arguments are those of launch files"),
        (arguments.journal.as_ref().map(|_| "--journal".to_owned()), "journals are those of nodes"),
        (arguments.seconds.map(|_| "--seconds".to_owned()), "the file says its `duration`"),
        (arguments.seed.map(|_| "--seed".to_owned()), "nothing in it is random"),
    ];
    let ignored = given.into_iter().find_map(|(ignored, remedy)| Some((ignored?, remedy)));
    ignored.map_or(Ok(()), |(ignored, remedy)| Err(SimError::Ignored { path: arguments.file.clone(), ignored, remedy }))
}

/// A scenario file with its text; nothing for launch files, whose own reader says what is wrong with them. What is no YAML is neither.
pub(in crate::command) fn read(file: &Path) -> Result<Option<(Scenario, String)>, SimError> {
    let name = file.display().to_string();
    let text = Disk.read("FILE", &name)?;
    trench_config::yaml::parse(&name, &text)?;
    if !trench_scenario::is_scenario(&text) {
        return Ok(None);
    }
    let scenario = trench_scenario::parse(&name, &text)?;
    Ok(Some((scenario, text)))
}

fn write_csv(arguments: &Arguments, run: &Run) -> Result<(), SimError> {
    let Some(path) = &arguments.csv else { return Ok(()) };
    fs::write(path, run.to_csv()).map_err(|error| SimError::Io { path: path.clone(), error })
}

/// The run of a scenario that names a launch file, without its bag and its verdict.
pub(in crate::command) fn launched(scenario: &Path, launch: &trench_scenario::Launch) -> Result<Run, SimError> {
    silently(scenario, launch).map_err(|error| error.of_scenario(launch))
}

fn silently(scenario: &Path, launch: &trench_scenario::Launch) -> Result<Run, SimError> {
    let file = scenario.parent().unwrap_or(Path::new("")).join(&launch.file);
    let plan = plan(&file, &launch.pairs().into_iter().collect())?;
    let mut lockstep = Lockstep::new(load_journalled(&plan, &Disk, SEED, None)?.instances)?;
    let from = lockstep.times().steady;
    let mut watch = Watch { sink: Sink::new(None)?, quiet: true, from, progress: Progress::new(true) };
    lockstep.run(LONGEST, &mut watch);
    watch.progress.clear();
    Ok(watch.sink.finish()?)
}

/// Drives a launch file; `scenario` is the text of the scenario that names it.
fn drive(arguments: &Arguments, scenario: Option<&str>) -> Result<u8, SimError> {
    let plan = plan(&arguments.file, &arguments.arguments.iter().cloned().collect())?;
    if let Some(folder) = arguments.journal.as_ref().filter(|folder| folder.exists()) {
        return Err(SimError::JournalsExist(folder.display().to_string()));
    }
    let folder = arguments.journal.clone();
    let journals = folder.map(|folder| Journals { folder, images: arguments.journal_images, pace: Pace::LockStep });
    let loaded = load_journalled(&plan, &Disk, arguments.seed.unwrap_or(SEED), journals.as_ref())?;
    for label in &loaded.left_out {
        eprintln!("trench sim: {label} is no node of ours and is left out");
    }
    let mut lockstep = Lockstep::new(loaded.instances)?;
    let (began, from) = (Instant::now(), lockstep.times().steady);
    let (sink, progress) = (Sink::new(arguments.bag.as_deref())?, Progress::new(!arguments.quiet));
    let mut watch = Watch { sink, quiet: arguments.quiet, from, progress };
    if let Some(text) = scenario {
        let text = trench_msgs::std_msgs::String { data: text.to_owned() };
        watch.sink.publish(lockstep.times().ros.0, "/scenario", Qos::LATCHED, &text);
    }
    let ending = lockstep.run(arguments.seconds.unwrap_or(LONGEST), &mut watch);
    watch.progress.clear();
    let (took, simulated) = (began.elapsed().as_secs_f64(), lockstep.times().steady.seconds_since(from));
    let run = watch.sink.finish()?;
    write_csv(arguments, &run)?;
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
    sink: Sink,
    quiet: bool,
    /// When the simulation began.
    from: Steady,
    progress: Progress,
}

impl Observer for Watch {
    fn published(&mut self, at: Times, topic: &str, advertise: &Advertise, source: Source, cdr: &[u8]) {
        self.progress.at(|| format!("{:.0} s simulated", at.steady.seconds_since(self.from)));
        self.sink.take(at.ros.0, topic, (advertise.type_info, advertise.qos), source.sequence as u32, cdr);
    }

    fn logged(&mut self, at: Times, node: &str, level: Level, text: &str) {
        if level >= Level::Warn || (!self.quiet && level >= Level::Info) {
            self.progress.clear();
            eprintln!("[{:9.3}] {node}: {text}", at.steady.0 as f64 * 1e-9);
        }
    }
}
