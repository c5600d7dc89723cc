//! From a command line to a running process.

use crate::checkpoint::Checkpoint;
use crate::clock::{self, Clock};
use crate::exit::Exit;
use crate::help;
use crate::journals::journals;
use crate::lease::{Lease, Taken};
use crate::log::{Logger, logger_name};
use crate::node::{Equipment, connect};
use crate::parameters::ParameterServer;
use crate::process::Process;
use crate::security::enclave;
use crate::transport::{Backend, TransportError, full_name};
use crate::watchdog::Watchdog;
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use std::process::ExitCode;
use std::sync::Once;
use std::time::Duration;
use std::{env, io};
use trench_config::params::USE_SIM_TIME;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::arguments::{
    Arguments, CLOCK_REFERENCE, NETWORK_RATE, Names, PUBLISH_OVER_NETWORK, READ_BEST_EFFORT, SERVE_CLOCK, UsageError,
    process_parameters,
};
use trench_core::{Files, NodeContext, NodeCore, NodeDescription};
use trench_journal::{BuildError, Disk, Journals};

/// The highest domain whose ports exist.
const LAST_DOMAIN: u16 = 232;

/// Why a process ends before or while it runs.
#[derive(Debug, thiserror::Error)]
enum RunError {
    #[error(transparent)]
    Usage(#[from] UsageError),
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Config(Vec<ConfigError>),
    #[error(transparent)]
    Build(#[from] BuildError),
    #[error(transparent)]
    Transport(#[from] TransportError),
    #[error(transparent)]
    Taken(#[from] Taken),
    #[error("the event loop failed: {0}")]
    System(#[from] io::Error),
}

impl RunError {
    fn exit(&self) -> Exit {
        match self {
            Self::Usage(_) => Exit::Usage,
            Self::Config(_) | Self::Build(BuildError::Start(_)) => Exit::Configuration,
            Self::Transport(_) => Exit::Transport,
            Self::Taken(_) => Exit::Taken,
            Self::System(_) | Self::Build(BuildError::Journal(_)) => Exit::System,
        }
    }
}

/// Runs a node as this process does with its command line, until it is asked to end. What is wrong is said on standard
/// error, and the exit code says of which kind it is ([`Exit`]). Where the environment asks for journals
/// (`TRENCH_JOURNAL_DIR`), the node keeps one.
#[must_use]
pub fn run(description: NodeDescription) -> ExitCode {
    run_with(description, journals(|name| env::var_os(name)), false)
}

/// As [`run`], for nodes of which two would work against each other: a second process of this node in the same domain of
/// this host is refused.
#[must_use]
pub fn run_alone(description: NodeDescription) -> ExitCode {
    run_with(description, journals(|name| env::var_os(name)), true)
}

/// As [`run`], for nodes that a journal could not replay because their cores are not pure: they read or write files or
/// devices by themselves.
#[must_use]
pub fn run_without_journal(description: NodeDescription) -> ExitCode {
    run_with(description, None, false)
}

/// As [`run_without_journal`] with this command line instead of the process's own; gives the exit code. It returns, so
/// that a program can run a node once more.
#[must_use]
pub fn run_with_arguments(description: NodeDescription, arguments: impl Iterator<Item = String>) -> u8 {
    try_run(description, arguments, None, false).unwrap_or_else(|error| {
        eprintln!("{}: {error}", description.name);
        error.exit() as u8
    })
}

fn run_with(description: NodeDescription, journals: Option<Journals>, is_single: bool) -> ExitCode {
    match try_run(description, env::args().skip(1), journals.as_ref(), is_single) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("{}: {error}", description.name);
            error.exit().into()
        }
    }
}

fn try_run(
    description: NodeDescription,
    command_line: impl Iterator<Item = String>,
    journals: Option<&Journals>,
    is_single: bool,
) -> Result<u8, RunError> {
    end_with_any_thread();
    let arguments = Arguments::parse(command_line)?;
    let mut descriptors = (description.parameters)();
    descriptors.extend(process_parameters());
    if arguments.help {
        print!("{}", help::text(&description, &descriptors));
        return Ok(0);
    }
    let domain = domain(env::var("ROS_DOMAIN_ID").ok())?;
    let backend = Backend::of(env::var("RMW_IMPLEMENTATION").ok().as_deref()).map_err(UsageError::RmwImplementation)?;
    let enclave = enclave(backend, |name| env::var(name).ok(), &arguments.enclave)?;
    // All cores first: what is wrong with one of them ends the process before it works.
    let mut prepared = Vec::new();
    let nodes = arguments.of_each_node(description.name);
    for arguments in &nodes {
        prepared.push(prepare(description, arguments, &descriptors, domain, (journals, is_single))?);
    }
    if prepared.len() > 1 {
        raise_file_limit();
    }
    let patience = OPENING + OPENING_ONE * u32::try_from(prepared.len()).unwrap_or(u32::MAX);
    let opening = Watchdog::new(patience, Exit::Transport as u8, "the network did not open all topics");
    let mut process = Process::new(backend, domain, enclave.as_deref())?;
    let mut leases = Vec::new();
    for Prepared { core, names, equipment, lease } in prepared {
        leases.push(lease);
        let index = process.nodes.len();
        let node = connect(core, index, &names, equipment, &mut process.connections())?;
        process.nodes.push(node);
    }
    process.network.announce()?;
    drop(opening);
    let code = process.run()?;
    drop(leases);
    Ok(code)
}

/// A process whose network has died of a bug and that goes on deaf is worse than none: whoever supervises it starts it again.
fn end_with_any_thread() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let tell = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            tell(panic);
            std::process::abort();
        }));
    });
}

/// How long the network may take to open, for the process and for each of its nodes.
const OPENING: Duration = Duration::from_secs(8);
const OPENING_ONE: Duration = Duration::from_secs(1);

/// A node that is not connected yet.
struct Prepared<'a> {
    core: Box<dyn NodeCore>,
    names: Names<'a>,
    equipment: Equipment,
    /// Held for as long as the process lives, by nodes of which there is one.
    lease: Option<Lease>,
}

fn prepare<'a>(
    description: NodeDescription,
    arguments: &'a Arguments,
    descriptors: &[ParameterDescriptor],
    domain: u16,
    (journals, is_single): (Option<&Journals>, bool),
) -> Result<Prepared<'a>, RunError> {
    let names = Names::new(&arguments.remaps, description.name);
    let full = full_name(&names.namespace, &names.node);
    let parameters = arguments
        .resolve_parameters(&names, descriptors, |path| Disk.read("--params-file", path))
        .map_err(RunError::Config)?;
    let checkpoint = Checkpoint::of(&full, domain);
    let lease = if is_single { Some(Lease::take(&checkpoint.lock_path(), &full, domain)?) } else { None };
    let core = build(description, &names, &checkpoint, &parameters, journals)?;
    let use_sim_time = parameters.bool(USE_SIM_TIME).map_err(|error| RunError::Config(vec![error]))?;
    let reference = parameters.str(CLOCK_REFERENCE).map_err(|error| RunError::Config(vec![error]))?.to_owned();
    if use_sim_time && !reference.is_empty() {
        let problem = "contradicts use_sim_time: ROS time is either /clock or another host's";
        return Err(RunError::Config(vec![parameters.error(CLOCK_REFERENCE, problem, "leave one of them out")]));
    }
    let serve_clock = parameters.bool(SERVE_CLOCK).map_err(|error| RunError::Config(vec![error]))?;
    let topics =
        |name| parameters.str_list(name).map(<[String]>::to_vec).map_err(|error| RunError::Config(vec![error]));
    let (publish_over_network, read_best_effort) = (topics(PUBLISH_OVER_NETWORK)?, topics(READ_BEST_EFFORT)?);
    let network_rate = parameters.f64(NETWORK_RATE).map_err(|error| RunError::Config(vec![error]))?;
    let name = logger_name(&full);
    let level = arguments.level_of(&name);
    let equipment = Equipment {
        clock: Clock::new(use_sim_time, !reference.is_empty()),
        clock_reference: Some(reference).filter(|name| !name.is_empty()),
        serve_clock,
        logger: Logger::new(name, level, arguments.console),
        rosout: arguments.rosout,
        checkpoint,
        publish_over_network,
        read_best_effort,
        network_rate,
        parameters: ParameterServer::new(full, descriptors.to_vec(), parameters),
    };
    Ok(Prepared { core, names, equipment, lease })
}

/// Lets the process open as many files as it may: each topic and service of each node needs some.
fn raise_file_limit() {
    let limit = getrlimit(Resource::Nofile);
    // Where it stays as it is, opening an endpoint says what is missing.
    let _unchanged = setrlimit(Resource::Nofile, Rlimit { current: limit.maximum, maximum: limit.maximum });
}

fn domain(variable: Option<String>) -> Result<u16, UsageError> {
    let Some(text) = variable.filter(|text| !text.is_empty()) else { return Ok(0) };
    text.parse().ok().filter(|domain| *domain <= LAST_DOMAIN).ok_or(UsageError::Domain(text))
}

fn build(
    description: NodeDescription,
    names: &Names<'_>,
    checkpoint: &Checkpoint,
    parameters: &Parameters,
    journals: Option<&Journals>,
) -> Result<Box<dyn NodeCore>, RunError> {
    let context = NodeContext {
        namespace: names.namespace.clone(),
        name: names.node.clone(),
        checkpoint: checkpoint.read()?,
        seed: seed()?,
        wall: clock::wall_now(),
    };
    Ok(trench_journal::build(&description, &context, parameters, &Disk, names, journals)?)
}

/// The host's randomness.
fn seed() -> io::Result<u64> {
    let mut bytes = [0; 8];
    rustix::rand::getrandom(&mut bytes, rustix::rand::GetRandomFlags::empty())?;
    Ok(u64::from_le_bytes(bytes))
}
