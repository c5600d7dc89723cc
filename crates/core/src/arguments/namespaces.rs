//! Several nodes of one kind in one process: `--namespaces [robot1, robot2]`, one node in each namespace.

use super::{Arguments, Names, Remap, UsageError};
use crate::resolve_name;
use std::collections::BTreeSet;
use trench_config::ParameterValue;
use trench_config::params::parse_value;

/// Reads a list of names in YAML, or one name.
pub(super) fn parse(text: &str) -> Result<Vec<String>, UsageError> {
    let wrong = || UsageError::Namespaces(text.to_owned());
    let namespaces = match parse_value("--namespaces", text) {
        Ok(Some(ParameterValue::StringArray(names))) => names,
        Ok(Some(ParameterValue::String(name))) => vec![name],
        _ => return Err(wrong()),
    };
    let distinct: BTreeSet<&str> = namespaces.iter().map(|name| name.trim_matches('/')).collect();
    if distinct.len() < namespaces.len() || distinct.contains("") {
        return Err(wrong());
    }
    Ok(namespaces)
}

impl Arguments {
    /// What the command line means for each node of the process, in order: its own namespace, and all else in common. A
    /// relative namespace lies below the one that `-r __ns:=` says.
    #[must_use]
    pub fn of_each_node(&self, default_name: &str) -> Vec<Self> {
        if self.namespaces.is_empty() {
            return vec![self.clone()];
        }
        let base = Names::new(&self.remaps, default_name).namespace;
        let in_namespace = |namespace: &String| {
            // The first rule that fits a name applies.
            let own = Remap::namespace(resolve_name(namespace.trim_end_matches('/'), &base, default_name));
            let remaps = std::iter::once(own).chain(self.remaps.iter().cloned()).collect();
            Self { remaps, namespaces: Vec::new(), ..self.clone() }
        };
        self.namespaces.iter().map(in_namespace).collect()
    }
}
