//! Reading the files, and those that they lead to.

use super::super::launch::name_and_value;
use super::super::named;
use super::admit::{self, CONTROLLER};
use super::bed::{Field, field, starts};
use super::{Kind, kind};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use trench_check::{Controller, Passing, Standing, Start, Team, team};
use trench_config::params::{Source, resolve};
use trench_config::{ConfigError, Parameters};
use trench_core::{Files, StartError};
use trench_harness::{Disk, LoadError, catalog};
use trench_launch::Process;
use trench_plan::Plan;
use trench_scenario::{Scenario, Task};

/// A file that cannot be judged.
#[derive(Debug, thiserror::Error)]
pub(super) enum CheckError {
    #[error(transparent)]
    Config(#[from] ConfigError),
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Parameters(Vec<ConfigError>),
    #[error(transparent)]
    Load(#[from] LoadError),
    #[error("no launch file that is checked has the argument {0}; trench launch FILE --show-args lists them")]
    Argument(String),
    #[error("no node is called {0}")]
    NoNode(&'static str),
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Refused(Vec<LoadError>),
    #[error(transparent)]
    Start(#[from] StartError),
}

impl CheckError {
    /// The error about a launch file, told where the scenario names it.
    fn of_scenario(self, launch: &trench_scenario::Launch) -> Self {
        match self {
            Self::Config(error) => Self::Config(launch.blamed(error)),
            Self::Load(error) => Self::Config(named::refused(launch, &error)),
            Self::Refused(errors) => {
                Self::Parameters(errors.iter().map(|error| named::refused(launch, error)).collect())
            }
            other => other,
        }
    }
}

/// All there is to judge.
pub(super) struct Gathered {
    pub(super) controllers: Vec<Controller>,
    /// By file.
    pub(super) formations: Vec<(String, Plan)>,
    /// By file.
    pub(super) scenarios: Vec<(String, Scenario)>,
    /// The robots that take the formations up.
    pub(super) team: Team,
    /// By file.
    pub(super) fields: Vec<(String, Vec<Standing>, Passing)>,
}

/// Where a controller stands whose launch file is not known.
const NAMESPACE: &str = "/robot1";

const ASSIGNMENT: &str = "leader_assignment";
const MAPPER: &str = "obstacle_mapper";
const TESTBED: &str = "testbed";

/// Reads all that `words` name: files, and `NAME:=VALUE`.
pub(super) fn gather(words: &[String]) -> Result<Gathered, CheckError> {
    let arguments: Vec<(String, String)> = words.iter().filter_map(|word| name_and_value(word).ok()).collect();
    let files: Vec<&Path> = words.iter().filter(|word| !word.contains(":=")).map(Path::new).collect();
    let mut unknown: Vec<&String> = arguments.iter().map(|(name, _)| name).collect();
    let (mut controllers, mut formations, mut scenarios, mut robots) = (Vec::new(), Vec::new(), Vec::new(), None);
    let (mut fields, mut begin, mut edges) = (Vec::new(), Vec::new(), None);
    let mut parameter_files: Vec<(String, String)> = Vec::new();
    // With what scenarios say of them.
    let mut launches: Vec<(PathBuf, Option<trench_scenario::Launch>)> = Vec::new();
    for path in files {
        let name = path.display().to_string();
        let text = Disk.read("FILE", &name)?;
        match kind(&name, &text)? {
            Kind::Formation => formations.push((name.clone(), trench_plan::parse(&name, &text)?)),
            Kind::Parameters => parameter_files.push((name, text)),
            Kind::Scenario => {
                let scenario = trench_scenario::parse(&name, &text)?;
                match &scenario.task {
                    Task::Launch(task) => {
                        let file = path.parent().unwrap_or(Path::new("")).join(&task.file);
                        launches.push((file, Some(task.overridden_by(&arguments))));
                    }
                    _ => scenarios.push((name.clone(), scenario)),
                }
            }
            Kind::Launch => launches.push((path.to_owned(), None)),
        }
    }
    for (file, scenario) in launches {
        let of_scenario = |error: CheckError| match &scenario {
            Some(scenario) => error.of_scenario(scenario),
            None => error,
        };
        let known = trench_launch::arguments(&file).map_err(|error| of_scenario(error.into()))?;
        let known: Vec<String> = known.into_iter().map(|argument| argument.name).collect();
        unknown.retain(|name| !known.contains(name));
        let own = scenario.iter().flat_map(trench_scenario::Launch::pairs);
        let given = arguments.iter().filter(|(name, _)| known.contains(name)).cloned();
        let launched = launch(&file, own.chain(given).collect()).map_err(of_scenario)?;
        fields.extend(launched.field()?);
        begin.extend(launched.starts()?);
        edges = launched.edges()?.or(edges);
        formations.extend(launched.formations);
        robots = launched.robots.or(robots);
        controllers.extend(launched.controllers);
    }
    if let Some(name) = unknown.first() {
        return Err(CheckError::Argument((*name).clone()));
    }
    let default = from_files(&parameter_files)?;
    let known = controllers.first().map_or(&default.parameters, |controller| &controller.parameters);
    let mut team = Team { starts: begin, ..team(known, robots)? };
    if controllers.is_empty() {
        team.field = edges.unwrap_or(team.field);
    }
    if !parameter_files.is_empty() {
        controllers.push(default);
    }
    Ok(Gathered { controllers, formations, scenarios, team, fields })
}

/// The controller that parameter files describe: in any namespace, with defaults for what they leave out.
fn from_files(files: &[(String, String)]) -> Result<Controller, CheckError> {
    let sources: Vec<Source<'_>> = files.iter().map(|(name, text)| Source::File { name, text }).collect();
    let node = catalog::node(CONTROLLER).ok_or(CheckError::NoNode(CONTROLLER))?;
    let parameters = resolve(&sources, NAMESPACE, CONTROLLER, &(node.parameters)()).map_err(CheckError::Parameters)?;
    admit::controller(NAMESPACE, &parameters)?;
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    Ok(Controller { name: names.join(" + "), parameters })
}

#[derive(Default)]
struct Launched {
    controllers: Vec<Controller>,
    formations: Vec<(String, Plan)>,
    robots: Option<usize>,
    assignment: Option<Parameters>,
    mapper: Option<Parameters>,
    bed: Option<Parameters>,
}

impl Launched {
    /// What stands in the field of the test bed, if a mapper makes hulls of it for controllers.
    fn field(&self) -> Result<Option<Field>, CheckError> {
        match (&self.bed, &self.mapper, self.controllers.first()) {
            (Some(bed), Some(mapper), Some(one)) => field(bed, mapper, &one.parameters),
            _ => Ok(None),
        }
    }

    /// The field as the assignment knows it, low and high x, low and high y, m: all that tells of it where controllers run on hosts of
    /// their own.
    fn edges(&self) -> Result<Option<[[f64; 2]; 2]>, CheckError> {
        match &self.assignment {
            Some(assignment) if !assignment.f64_list("field")?.is_empty() => {
                let [low_x, low_y, high_x, high_y] = assignment.f64_array("field")?;
                Ok(Some([[low_x, high_x], [low_y, high_y]]))
            }
            _ => Ok(None),
        }
    }

    /// Where the robots of the test bed begin, and whom they will follow.
    fn starts(&self) -> Result<Vec<Start>, CheckError> {
        match (&self.bed, &self.assignment, self.controllers.first(), self.formations.first()) {
            (Some(bed), Some(assignment), Some(one), Some((_, plan))) => starts(bed, assignment, &one.parameters, plan),
            _ => Ok(Vec::new()),
        }
    }
}

/// The controllers and the formation that a launch file starts.
fn launch(file: &Path, arguments: BTreeMap<String, String>) -> Result<Launched, CheckError> {
    let plan = trench_harness::plan(file, &arguments)?;
    admit::launched(&plan)?;
    let mut launched = Launched::default();
    for process in &plan.processes {
        match program(process) {
            Some(CONTROLLER) => {
                let nodes = parameters(CONTROLLER, process)?.into_iter();
                launched.controllers.extend(nodes.map(|(name, parameters)| Controller { name, parameters }));
            }
            Some(ASSIGNMENT) => {
                let Some((_, parameters)) = parameters(ASSIGNMENT, process)?.pop() else { continue };
                launched.robots = Some(parameters.str_list("robots")?.len());
                let path = parameters.str("formation_file")?;
                if !path.is_empty() {
                    let plan = trench_plan::parse(path, &Disk.read("formation_file", path)?)?;
                    launched.formations.push((readable(path), plan));
                }
                launched.assignment = Some(parameters);
            }
            Some(MAPPER) => launched.mapper = one(MAPPER, process)?,
            Some(TESTBED) => launched.bed = one(TESTBED, process)?,
            _ => {}
        }
    }
    Ok(launched)
}

/// The parameters of a process that is one node.
fn one(node: &'static str, process: &Process) -> Result<Option<Parameters>, CheckError> {
    Ok(parameters(node, process)?.pop().map(|(_, parameters)| parameters))
}

/// A path without detours, from the present folder on if it lies there.
pub(super) fn readable(path: &str) -> String {
    let Ok(absolute) = std::fs::canonicalize(path) else { return path.to_owned() };
    let here = std::env::current_dir().and_then(std::fs::canonicalize);
    match here.ok().and_then(|here| absolute.strip_prefix(here).ok().map(Path::to_owned)) {
        Some(relative) => relative.display().to_string(),
        None => absolute.display().to_string(),
    }
}

fn program(process: &Process) -> Option<&str> {
    Path::new(process.argv.first()?).file_name()?.to_str()
}

fn parameters(node: &'static str, process: &Process) -> Result<Vec<(String, Parameters)>, CheckError> {
    let node = catalog::node(node).ok_or(CheckError::NoNode(node))?;
    Ok(trench_harness::parameters(&node, process, &Disk)?)
}
