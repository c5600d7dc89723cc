//! From a process action to a process.

use super::{Resolver, variable_name};
use crate::literal::Literal;
use crate::parse::{Command, ProcessAction, Text, Word};
use crate::plan::{Output, Process};
use crate::scope::Scope;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use trench_config::ConfigError;
use trench_config::yaml::Node;

impl Resolver<'_> {
    pub(super) fn process(
        &mut self,
        action: &ProcessAction<'_>,
        node: &Node,
        scope: &Scope,
    ) -> Result<(), ConfigError> {
        let index = self.plan.processes.len() + 1;
        let (argv, parameter_files) = match &action.command {
            Command::Executable(command, text) => (perform_words(command, text, scope)?, Vec::new()),
            Command::Node(node) => self.node(node, index, scope)?,
        };
        let label = match &action.label {
            Some(label) => label.perform(scope)?,
            None => Path::new(&argv[0]).file_name().unwrap_or_default().to_string_lossy().into_owned(),
        };
        let respawn = match &action.respawn {
            Some((text, respawn)) if switch(text, scope)? => Some(*respawn),
            _ => None,
        };
        let process = Process {
            label: format!("{label}-{index}"),
            is_node: matches!(action.command, Command::Node(_)),
            argv,
            environment: self.environment(&action.environment, scope)?,
            folder: action.folder.as_ref().map(|folder| folder.perform(scope)).transpose()?.map(PathBuf::from),
            parameter_files,
            start_after: scope.start_after,
            output: action.output.as_ref().map_or(Ok(Output::Log), |text| output(text, scope))?,
            respawn,
            ends_run: action.ends_run,
            sigterm_timeout: action.sigterm_timeout,
            sigkill_timeout: action.sigkill_timeout,
            origin: node.origin.clone(),
        };
        if process.label.contains('/') {
            return Err(node.error(format!("`{label}` is no label"), "write a name without `/`"));
        }
        self.plan.processes.push(process);
        Ok(())
    }

    /// What differs from the launcher's own environment.
    fn environment(
        &self,
        own: &[(Text<'_>, Text<'_>)],
        scope: &Scope,
    ) -> Result<BTreeMap<String, Option<String>>, ConfigError> {
        let mut wanted = scope.environment.clone();
        for (name, value) in own {
            wanted.insert(variable_name(name, scope)?, value.perform(scope)?);
        }
        let inherited = self.request.environment;
        let mut changes: BTreeMap<String, Option<String>> = wanted
            .into_iter()
            .filter(|(name, value)| inherited.get(name) != Some(value))
            .map(|(name, value)| (name, Some(value)))
            .collect();
        for name in inherited.keys() {
            if !scope.environment.contains_key(name) {
                changes.entry(name.clone()).or_insert(None);
            }
        }
        Ok(changes)
    }
}

/// The words of a command line with their substitutions made.
pub(super) fn perform_words(words: &[Word], text: &Text<'_>, scope: &Scope) -> Result<Vec<String>, ConfigError> {
    words.iter().map(|word| Text { template: word.clone(), node: text.node }.perform(scope)).collect()
}

/// A text that YAML reads as a boolean. (Conditions know fewer words, there as here.)
fn switch(text: &Text<'_>, scope: &Scope) -> Result<bool, ConfigError> {
    match Literal::resolve(&text.perform(scope)?) {
        Literal::Bool(value) => Ok(value),
        Literal::Int(value @ (0 | 1)) => Ok(value == 1),
        _ => Err(text.node.error("is neither true nor false", "write \"true\" or \"false\"")),
    }
}

fn output(text: &Text<'_>, scope: &Scope) -> Result<Output, ConfigError> {
    match text.perform(scope)?.as_str() {
        "log" | "own_log" => Ok(Output::Log),
        "screen" | "both" | "full" => Ok(Output::Screen),
        _ => Err(text.node.error("is no output known here", "write log, own_log, screen, both or full")),
    }
}
