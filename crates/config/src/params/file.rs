//! Reading a parameter file: `node: {ros__parameters: {...}}`, nodes in nested namespaces, parameters in nested maps.

use super::typed;
use crate::yaml::{self, Entry, Node, Value};
use crate::{ConfigError, Origin, ParameterValue};

/// The key under which a node's parameters stand.
const PARAMETERS: &str = "ros__parameters";

/// One value for one parameter of the nodes that a pattern matches.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Assignment {
    /// Full node name or pattern; without a leading `/` it is in the root namespace.
    pub(super) node: String,
    /// Dotted name.
    pub(super) name: String,
    /// The value; `None` for an empty list, which has no type.
    pub(super) value: Option<ParameterValue>,
    /// Where it stands.
    pub(super) origin: Origin,
}

/// All that `text` assigns, in its order. What is wrong goes to `errors`, and reading continues behind it.
pub(super) fn read(file: &str, text: &str, errors: &mut Vec<ConfigError>) -> Vec<Assignment> {
    let mut found = Vec::new();
    match yaml::parse(file, text) {
        Err(error) => errors.push(error),
        Ok(root) if root.is_empty() => {}
        Ok(root) => nodes(&root, "", &mut found, errors),
    }
    found
}

/// Reads the level of namespaces and node names.
fn nodes(node: &Node, name: &str, found: &mut Vec<Assignment>, errors: &mut Vec<ConfigError>) {
    let Value::Map(entries) = &node.value else {
        errors.push(node.unexpected(&format!("a node name with `{PARAMETERS}:` below it")));
        return;
    };
    for Entry { key, node, .. } in entries {
        if key != PARAMETERS {
            let separator = if name.is_empty() || name.ends_with('/') || key.starts_with('/') { "" } else { "/" };
            nodes(node, &format!("{name}{separator}{key}"), found, errors);
        } else if name.is_empty() {
            errors.push(node.error(format!("`{PARAMETERS}` stands without a node name"), "write `/**:` above it"));
        } else {
            parameters(node, name, "", found, errors);
        }
    }
}

/// Reads the level of parameters: nested maps become dotted names.
fn parameters(node: &Node, node_name: &str, prefix: &str, found: &mut Vec<Assignment>, errors: &mut Vec<ConfigError>) {
    let Value::Map(entries) = &node.value else {
        errors.push(node.unexpected("a map of parameters"));
        return;
    };
    for Entry { key, node, origin } in entries {
        let name = if prefix.is_empty() { key.clone() } else { format!("{prefix}.{key}") };
        if matches!(node.value, Value::Map(_)) {
            parameters(node, node_name, &name, found, errors);
            continue;
        }
        match typed::value(node, &name) {
            Ok(value) => {
                found.push(Assignment { node: node_name.to_owned(), name, value, origin: origin.clone() });
            }
            Err(error) => errors.push(error),
        }
    }
}
