//! From actions to a plan: variables, conditions, includes and groups in the order of the file.

mod node;
mod parameters;
mod process;

use crate::parse::{self, Action, Kind, Text, seconds};
use crate::plan::{Argument, Plan};
use crate::scope::{Scope, is_valid_namespace};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use trench_config::yaml::{self, Node};
use trench_config::{ConfigError, Origin, did_you_mean};

/// What to resolve.
#[derive(Debug, Clone)]
pub struct Request<'a> {
    /// The launch file.
    pub file: &'a Path,
    /// `name:=value` of the command line.
    pub arguments: &'a BTreeMap<String, String>,
    /// The launcher's environment.
    pub environment: &'a BTreeMap<String, String>,
    /// Variables that the launcher sets for all processes.
    pub additions: &'a BTreeMap<String, String>,
    /// Where parameter files will be written.
    pub parameter_folder: &'a Path,
}

/// The plan of a launch file.
///
/// # Errors
/// The first thing that is wrong with the file, the files it includes or the arguments.
pub fn resolve(request: &Request<'_>) -> Result<Plan, ConfigError> {
    let mut environment = request.environment.clone();
    environment.extend(request.additions.clone());
    let mut scope = Scope { variables: request.arguments.clone(), environment, ..Scope::default() };
    let mut resolver = Resolver {
        request,
        plan: Plan::default(),
        declared: BTreeSet::new(),
        open: Vec::new(),
        nodes: BTreeMap::new(),
    };
    resolver.file(request.file, None, &mut scope)?;
    for name in request.arguments.keys() {
        if !resolver.declared.contains(name) {
            return Err(ConfigError {
                origin: Origin::new("command line", 0),
                key: name.clone(),
                value: request.arguments[name].clone(),
                problem: "the launch file has no such argument".to_owned(),
                remedy: did_you_mean(name, resolver.declared.iter().map(String::as_str)),
            });
        }
    }
    Ok(resolver.plan)
}

/// The arguments that a launch file itself declares (not those of the files it includes), in its order.
///
/// # Errors
/// When it cannot be read, or is no launch file.
pub fn arguments(file: &Path) -> Result<Vec<Argument>, ConfigError> {
    fn collect(actions: Vec<Action<'_>>, found: &mut Vec<Argument>) {
        for action in actions {
            match action.kind {
                Kind::Argument { argument, .. } => found.push(argument),
                Kind::Group { actions, .. } => collect(actions, found),
                _ => {}
            }
        }
    }
    let root = yaml::parse(&file.display().to_string(), &read(file, None)?)?;
    let mut found = Vec::new();
    collect(parse::launch_file(&root)?, &mut found);
    Ok(found)
}

/// The text of a file that `named_by` names, or the command line.
fn read(file: &Path, named_by: Option<&Node>) -> Result<String, ConfigError> {
    std::fs::read_to_string(file).map_err(|error| {
        let problem = format!("cannot read {}: {error}", file.display());
        match named_by {
            Some(node) => node.error(problem, "check the path"),
            None => ConfigError {
                origin: Origin::new("command line", 0),
                key: String::new(),
                value: String::new(),
                problem,
                remedy: "check the path".to_owned(),
            },
        }
    })
}

struct Resolver<'a> {
    request: &'a Request<'a>,
    plan: Plan,
    /// Names of all arguments declared so far.
    declared: BTreeSet<String>,
    /// The launch files being read, the outermost first.
    open: Vec<PathBuf>,
    /// Full node names and where each was first given.
    nodes: BTreeMap<String, Origin>,
}

impl Resolver<'_> {
    fn file(&mut self, file: &Path, named_by: Option<&Node>, scope: &mut Scope) -> Result<(), ConfigError> {
        let text = read(file, named_by)?;
        let absolute = file.canonicalize().unwrap_or_else(|_| file.to_owned());
        if let Some(node) = named_by
            && self.open.contains(&absolute)
        {
            return Err(node.error("a launch file includes itself", "break the circle of includes"));
        }
        let folder = absolute.parent().unwrap_or(Path::new("/")).display().to_string();
        let outer_folder = std::mem::replace(&mut scope.folder, folder);
        self.open.push(absolute);
        let root = yaml::parse(&file.display().to_string(), &text)?;
        self.actions(&parse::launch_file(&root)?, scope)?;
        self.open.pop();
        scope.folder = outer_folder;
        Ok(())
    }

    fn actions(&mut self, actions: &[Action<'_>], scope: &mut Scope) -> Result<(), ConfigError> {
        for action in actions {
            if is_wanted(action, scope)? {
                self.action(action, scope)?;
            }
        }
        Ok(())
    }

    fn action(&mut self, action: &Action<'_>, scope: &mut Scope) -> Result<(), ConfigError> {
        match &action.kind {
            Kind::Argument { argument, default } => self.declare(action.node, argument, default.as_ref(), scope)?,
            Kind::Let { name, value } => {
                let value = value.perform(scope)?;
                scope.variables.insert(name.perform(scope)?, value);
            }
            Kind::Environment { name, value: Some(value) } => {
                let value = value.perform(scope)?;
                scope.environment.insert(variable_name(name, scope)?, value);
            }
            Kind::Environment { name, value: None } => {
                scope.environment.remove(&name.perform(scope)?);
            }
            Kind::PushNamespace(namespace) => {
                let pushed = namespace.perform(scope)?;
                scope.namespace = Some(valid_namespace(scope.namespace_of(Some(&pushed)), namespace.node)?);
            }
            Kind::Include { file, arguments } => {
                for (name, value) in arguments {
                    let value = value.perform(scope)?;
                    scope.variables.insert(name.perform(scope)?, value);
                }
                let path = PathBuf::from(file.perform(scope)?);
                self.file(&path, Some(file.node), scope)?;
            }
            Kind::Group { scoped: true, actions } => self.actions(actions, &mut scope.clone())?,
            Kind::Group { scoped: false, actions } => self.actions(actions, scope)?,
            Kind::Timer { period, actions } => {
                let text = period.perform(scope)?;
                let value = text.parse().map_err(|_| period.node.error("is not a number of seconds", "write 2.0"))?;
                let mut delayed = scope.clone();
                delayed.start_after += seconds(value, period.node)?;
                self.actions(actions, &mut delayed)?;
            }
            Kind::Process(process) => self.process(process, action.node, scope)?,
        }
        Ok(())
    }

    /// Declares an argument: its default becomes the variable's value where it has none.
    fn declare(
        &mut self,
        node: &Node,
        argument: &Argument,
        default: Option<&Text<'_>>,
        scope: &mut Scope,
    ) -> Result<(), ConfigError> {
        let name = &argument.name;
        self.declared.insert(name.clone());
        if !scope.variables.contains_key(name) {
            let default = default.ok_or_else(|| {
                let description = if argument.description.is_empty() {
                    String::new()
                } else {
                    format!(" ({})", argument.description)
                };
                node.error(format!("the argument `{name}`{description} has no value"), format!("add {name}:=VALUE"))
            })?;
            let value = default.perform(scope)?;
            scope.variables.insert(name.clone(), value);
        }
        let value = &scope.variables[name];
        if argument.choices.is_empty() || argument.choices.contains(value) {
            return Ok(());
        }
        let problem = format!("`{value}` is no value that the argument `{name}` allows");
        Err(node.error(problem, did_you_mean(value, argument.choices.iter().map(String::as_str))))
    }
}

fn is_wanted(action: &Action<'_>, scope: &Scope) -> Result<bool, ConfigError> {
    let Some((text, negated)) = &action.condition else { return Ok(true) };
    Ok(condition(text, scope)? != *negated)
}

/// Whether a text with the substitutions made is true.
fn condition(text: &Text<'_>, scope: &Scope) -> Result<bool, ConfigError> {
    let value = text.perform(scope)?;
    match value.trim().to_lowercase().as_str() {
        "true" | "1" => Ok(true),
        "false" | "0" => Ok(false),
        _ => Err(text.node.error(format!("`{value}` is neither true nor false"), "give true, false, 1 or 0")),
    }
}

/// The name of an environment variable, which must be one for the system.
fn variable_name(text: &Text<'_>, scope: &Scope) -> Result<String, ConfigError> {
    let name = text.perform(scope)?;
    if name.is_empty() || name.contains(['=', '\0']) {
        return Err(text.node.error("is no name of an environment variable", "write a name without `=`"));
    }
    Ok(name)
}

fn valid_namespace(namespace: Option<String>, node: &Node) -> Result<String, ConfigError> {
    let namespace = namespace.unwrap_or_else(|| "/".to_owned());
    if is_valid_namespace(&namespace) {
        return Ok(namespace);
    }
    let problem = format!("`{namespace}` is no namespace");
    Err(node.error(problem, "write parts of letters, digits and underscores, not beginning with a digit"))
}
