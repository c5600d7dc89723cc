//! From a resolved launch file to instances: the same files that start processes drive the simulator.

use crate::catalog;
use crate::lockstep::Instance;
use std::collections::BTreeMap;
use std::path::Path;
use trench_config::{ConfigError, Parameters};
use trench_core::arguments::{Arguments, Names, UsageError, process_parameters};
use trench_core::{Files, NodeContext, NodeDescription, StartError};
use trench_journal::{BuildError, Journals};
use trench_launch::{Plan, Process, Request};

/// Why a launch file cannot be driven in lock-step.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// A node's command line is wrong.
    #[error("{label}: {error}")]
    Usage {
        /// The process.
        label: String,
        /// What is wrong.
        error: UsageError,
    },
    /// A node's parameters are wrong.
    #[error("{label}: {}", errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Parameters {
        /// The process.
        label: String,
        /// All that is wrong.
        errors: Vec<ConfigError>,
    },
    /// A core refuses to start, or its journal cannot be made.
    #[error("{label}: {error}")]
    Start {
        /// The process.
        label: String,
        /// Why.
        error: Box<BuildError>,
    },
}

impl LoadError {
    /// The first value that it is about, if it is about one.
    #[must_use]
    pub fn about(&self) -> Option<&ConfigError> {
        match self {
            Self::Parameters { errors, .. } => errors.first(),
            Self::Start { error, .. } => match &**error {
                BuildError::Start(StartError::Config(error)) => Some(error),
                BuildError::Journal(_) => None,
            },
            Self::Usage { .. } => None,
        }
    }
}

/// The cores of a launch file, and the processes that are none of ours and stay out of the simulation.
pub struct Loaded {
    /// The cores, in the order of the file.
    pub instances: Vec<Instance>,
    /// Labels of what was left out.
    pub left_out: Vec<String>,
}

/// Resolves a launch file for lock-step: `render` is off unless it is asked for.
///
/// # Errors
/// The first thing that is wrong with the file, those it includes, or the arguments.
pub fn plan(file: &Path, arguments: &BTreeMap<String, String>) -> Result<Plan, ConfigError> {
    let mut arguments = arguments.clone();
    if trench_launch::arguments(file)?.iter().any(|argument| argument.name == "render") {
        arguments.entry("render".to_owned()).or_insert_with(|| "false".to_owned());
    }
    trench_launch::resolve(&Request {
        file,
        arguments: &arguments,
        environment: &std::env::vars().collect(),
        additions: &BTreeMap::new(),
        // Nobody writes them: their text is in the plan.
        parameter_folder: Path::new("parameters"),
    })
}

/// Makes the cores of all nodes that `plan` starts. `seed` goes to every core's context.
///
/// # Errors
/// At the first node that would not start as a process either.
pub fn load(plan: &Plan, files: &dyn Files, seed: u64) -> Result<Loaded, LoadError> {
    load_journalled(plan, files, seed, None)
}

/// As [`load`]; with `journals`, every core keeps a journal.
///
/// # Errors
/// As [`load`], and where a journal cannot be made.
pub fn load_journalled(
    plan: &Plan,
    files: &dyn Files,
    seed: u64,
    journals: Option<&Journals>,
) -> Result<Loaded, LoadError> {
    let mut loaded = Loaded { instances: Vec::new(), left_out: Vec::new() };
    for process in &plan.processes {
        match program(process).and_then(catalog::node) {
            Some(node) => {
                for arguments in each_node(&node, process)? {
                    let parameters = resolved(&node, &arguments, process, files)?;
                    let instance = instance_of(&node, arguments, &parameters, process, files, seed, journals)?;
                    loaded.instances.push(instance);
                }
            }
            None => loaded.left_out.push(process.label.clone()),
        }
    }
    Ok(loaded)
}

/// The name of a process's executable.
pub(crate) fn program(process: &Process) -> Option<&str> {
    Path::new(process.argv.first()?).file_name()?.to_str()
}

/// A node of a process, made with these parameters.
pub(crate) fn instance_of(
    node: &NodeDescription,
    arguments: Arguments,
    parameters: &Parameters,
    process: &Process,
    files: &dyn Files,
    seed: u64,
    journals: Option<&Journals>,
) -> Result<Instance, LoadError> {
    let names = Names::new(&arguments.remaps, node.name);
    let context =
        NodeContext { namespace: names.namespace.clone(), name: names.node.clone(), seed, ..NodeContext::default() };
    let core = trench_journal::build(node, &context, parameters, files, &names, journals)
        .map_err(|error| LoadError::Start { label: process.label.clone(), error: Box::new(error) })?;
    Ok(Instance { default_name: node.name.to_owned(), remaps: arguments.remaps, core })
}

/// The nodes of the kind `node` that `process` starts, each by its full name, with their parameters.
///
/// # Errors
/// When its command line or a parameter is wrong.
pub fn parameters(
    node: &NodeDescription,
    process: &Process,
    files: &dyn Files,
) -> Result<Vec<(String, Parameters)>, LoadError> {
    let named = |arguments: Arguments| {
        let names = Names::new(&arguments.remaps, node.name);
        let full_name = format!("{}/{}", names.namespace.trim_end_matches('/'), names.node);
        Ok((full_name, resolved(node, &arguments, process, files)?))
    };
    each_node(node, process)?.into_iter().map(named).collect()
}

/// The command line of `process`, for each of its nodes.
pub(crate) fn each_node(node: &NodeDescription, process: &Process) -> Result<Vec<Arguments>, LoadError> {
    let arguments = Arguments::parse(process.argv.iter().skip(1).cloned())
        .map_err(|error| LoadError::Usage { label: process.label.clone(), error })?;
    Ok(arguments.of_each_node(node.name))
}

pub(crate) fn resolved(
    node: &NodeDescription,
    arguments: &Arguments,
    process: &Process,
    files: &dyn Files,
) -> Result<Parameters, LoadError> {
    let names = Names::new(&arguments.remaps, node.name);
    let mut descriptors = (node.parameters)();
    // In lock-step there is no network to publish over.
    descriptors.extend(process_parameters());
    arguments
        .resolve_parameters(&names, &descriptors, |path| text(path, process, files))
        .map_err(|errors| LoadError::Parameters { label: process.label.clone(), errors })
}

/// The text of a parameter file that the launcher would write, or that is there.
fn text(path: &str, process: &Process, files: &dyn Files) -> Result<String, ConfigError> {
    match process.parameter_files.iter().find(|file| file.path == Path::new(path)) {
        Some(file) => Ok(file.text.clone()),
        None => files.read("--params-file", path),
    }
}
