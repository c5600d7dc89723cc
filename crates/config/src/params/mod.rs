//! ROS 2 parameter files and `-p name:=value`, as rcl reads them and rclcpp applies them.
//!
//! What applies to a node: entries of files under its full name beat entries under a wildcard (`/**`, `/*`, `/**/name`),
//! and `-p`, meant for the very process, counts like a full name; among equals the last one on the command line wins.
//! (rcl keeps one list for all of them in which the key that appears first is the weakest: the same for `/**` before
//! full names before `-p`, but `-p` then loses to a full name as soon as any file before it says `/**`.)
//! Stricter than ROS 2: a parameter that the node does not declare is an error, since it is nearly always a slip.

mod file;
mod pattern;
mod typed;

pub use typed::parse_value;

use crate::{ConfigError, Origin, ParameterDescriptor, ParameterValue, Parameters, did_you_mean};
use file::Assignment;
use pattern::Match;
use std::collections::BTreeMap;

/// The parameter that every ROS 2 node has: whether /clock is its time.
pub const USE_SIM_TIME: &str = "use_sim_time";

/// One `--params-file` or `-p` of a command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source<'a> {
    /// `--params-file NAME`
    File {
        /// For messages.
        name: &'a str,
        /// Its content.
        text: &'a str,
    },
    /// `-p [NODE:]NAME:=VALUE`
    Override {
        /// The node it is for: a bare name (in any namespace), a full name or a pattern; all nodes if `None`.
        node: Option<&'a str>,
        /// The parameter.
        name: &'a str,
        /// The value as YAML.
        value: &'a str,
    },
}

/// The parameters of the node `node_name` in `namespace` (`/` or `/robot1`): its declared ones and [`USE_SIM_TIME`],
/// with the values that `sources`, in the order of the command line, give them.
///
/// # Errors
/// All things that are wrong, in the order of the sources: bad syntax, and for this node unknown names, wrong types,
/// values out of range.
pub fn resolve(
    sources: &[Source<'_>],
    namespace: &str,
    node_name: &str,
    descriptors: &[ParameterDescriptor],
) -> Result<Parameters, Vec<ConfigError>> {
    let full_name = format!("{}/{node_name}", namespace.trim_end_matches('/'));
    let mut errors = Vec::new();
    let mut assigned: BTreeMap<String, (Match, ParameterValue, Origin)> = BTreeMap::new();
    let declared = declared_with_sim_time(descriptors);
    for source in sources {
        let assignments = assignments(source, &mut errors);
        for assignment in assignments {
            let Some(matched) = pattern::matches(&assignment.node, &full_name) else { continue };
            let rank = if matches!(source, Source::Override { .. }) { Match::FullName } else { matched };
            match check(&assignment, &declared) {
                Err(error) => errors.push(error),
                Ok(value) => {
                    let beaten = assigned.get(&assignment.name).is_none_or(|(previous, ..)| rank >= *previous);
                    if beaten {
                        assigned.insert(assignment.name, (rank, value, assignment.origin));
                    }
                }
            }
        }
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    let mut parameters = Parameters::default();
    for descriptor in &declared {
        parameters.insert(descriptor.name, descriptor.default.clone(), Origin::new("default", 0));
    }
    for (name, (_, value, origin)) in assigned {
        parameters.insert(name, value, origin);
    }
    Ok(parameters)
}

fn declared_with_sim_time(descriptors: &[ParameterDescriptor]) -> Vec<ParameterDescriptor> {
    let mut declared = descriptors.to_vec();
    if !declared.iter().any(|descriptor| descriptor.name == USE_SIM_TIME) {
        declared.push(ParameterDescriptor::bool(USE_SIM_TIME, false, "whether /clock is this node's time"));
    }
    declared
}

/// What one source says, for whichever node; its mistakes go to `errors`.
fn assignments(source: &Source<'_>, errors: &mut Vec<ConfigError>) -> Vec<Assignment> {
    match *source {
        Source::File { name, text } => file::read(name, text, errors),
        Source::Override { node, name, value } => {
            let origin = Origin::new("command line", 0);
            let pattern = match node {
                None => "/**".to_owned(),
                Some(node) if node.contains('/') => node.to_owned(),
                Some(node) => format!("/**/{node}"),
            };
            match parse_value(name, value) {
                Ok(value) => vec![Assignment { node: pattern, name: name.to_owned(), value, origin }],
                Err(error) => {
                    errors.push(error);
                    Vec::new()
                }
            }
        }
    }
}

/// The value, if the node declares the parameter and the value may be its.
fn check(assignment: &Assignment, declared: &[ParameterDescriptor]) -> Result<ParameterValue, ConfigError> {
    let Assignment { name, value, origin, .. } = assignment;
    let descriptor = declared.iter().find(|descriptor| descriptor.name == name).ok_or_else(|| ConfigError {
        origin: origin.clone(),
        key: name.clone(),
        value: value.as_ref().map(ToString::to_string).unwrap_or_default(),
        problem: "unknown parameter".to_owned(),
        remedy: did_you_mean(name, declared.iter().map(|descriptor| descriptor.name)),
    })?;
    // An empty list has no type of its own.
    let value = value.clone().or_else(|| typed::empty_list(&descriptor.default)).ok_or_else(|| ConfigError {
        origin: origin.clone(),
        key: name.clone(),
        value: "[]".to_owned(),
        problem: format!("is a list, declared as {}", descriptor.default.type_name()),
        remedy: format!("write {}, for example {}", descriptor.default.type_with_article(), descriptor.default),
    })?;
    descriptor.check(&value, origin)?;
    Ok(value)
}

#[cfg(test)]
mod tests;
