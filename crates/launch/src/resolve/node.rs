//! The command line of a ROS node: program, `args`, `ros_args`, name, namespace, parameters, remaps, in that order.

use super::process::perform_words;
use super::{Resolver, valid_namespace};
use crate::package;
use crate::parse::NodeCommand;
use crate::plan::ParameterFile;
use crate::scope::{Scope, is_valid_name};
use trench_config::{ConfigError, Origin};

impl Resolver<'_> {
    /// The arguments and parameter files of the `index`-th process.
    pub(super) fn node(
        &mut self,
        node: &NodeCommand<'_>,
        index: usize,
        scope: &Scope,
    ) -> Result<(Vec<String>, Vec<ParameterFile>), ConfigError> {
        let mut argv = vec![program(node, scope)?];
        if let Some((words, text)) = &node.arguments {
            argv.extend(perform_words(words, text, scope)?);
        }
        if let Some((words, text)) = &node.ros_arguments {
            argv.push("--ros-args".to_owned());
            argv.extend(perform_words(words, text, scope)?);
        }
        argv.push("--ros-args".to_owned());
        let name = node_name(node, scope)?;
        if let Some(name) = &name {
            argv.extend(["-r".to_owned(), format!("__node:={name}")]);
        }
        let namespace = namespace(node, scope)?;
        if let Some(namespace) = &namespace {
            argv.extend(["-r".to_owned(), format!("__ns:={namespace}")]);
        }
        // The real launcher puts a node's parameters under its full name only where both halves of it are known.
        let full_name = match (&name, &namespace) {
            (Some(name), Some(namespace)) => Some(format!("{}/{name}", namespace.trim_end_matches('/'))),
            _ => None,
        };
        if let (Some(name), Some(text)) = (&name, &node.name) {
            self.note_name(full_name.clone().unwrap_or_else(|| format!("/{name}")), &text.node.origin);
        }
        let key = full_name.as_deref().unwrap_or("/**");
        let (paths, files) = self.parameter_files(&node.parameters, key, index, scope)?;
        for path in paths {
            argv.extend(["--params-file".to_owned(), path]);
        }
        for (from, to) in &node.remaps {
            argv.extend(["-r".to_owned(), format!("{}:={}", from.perform(scope)?, to.perform(scope)?)]);
        }
        Ok((argv, files))
    }

    /// Warns where two nodes have one name: ROS 2 allows it, and tools then mix them up.
    fn note_name(&mut self, full_name: String, origin: &Origin) {
        if let Some(first) = self.nodes.get(&full_name) {
            self.plan.warnings.push(ConfigError {
                origin: origin.clone(),
                key: full_name,
                value: String::new(),
                problem: format!("two nodes have this name, the first at {first}"),
                remedy: "give each its own name or namespace".to_owned(),
            });
        } else {
            self.nodes.insert(full_name, origin.clone());
        }
    }
}

fn program(node: &NodeCommand<'_>, scope: &Scope) -> Result<String, ConfigError> {
    let executable = node.executable.perform(scope)?;
    if executable.is_empty() {
        return Err(node.executable.node.error("is empty", "write a path or a name on PATH"));
    }
    let Some(package) = &node.package else { return Ok(executable) };
    package::executable(&package.perform(scope)?, &executable, scope)
        .map_err(|failure| package.node.error(failure.problem, failure.remedy))
}

fn node_name(node: &NodeCommand<'_>, scope: &Scope) -> Result<Option<String>, ConfigError> {
    let Some(text) = &node.name else { return Ok(None) };
    let name = text.perform(scope)?;
    if is_valid_name(&name) {
        return Ok(Some(name));
    }
    let problem = format!("`{name}` is no node name");
    Err(text.node.error(problem, "write letters, digits and underscores, not beginning with a digit"))
}

fn namespace(node: &NodeCommand<'_>, scope: &Scope) -> Result<Option<String>, ConfigError> {
    match &node.namespace {
        None => Ok(scope.namespace.clone()),
        Some(text) => {
            let own = text.perform(scope)?;
            valid_namespace(scope.namespace_of(Some(&own)), text.node).map(Some)
        }
    }
}
