//! The parameter files of a node: each `param` entry becomes one of its own, in order.

use super::{Resolver, read};
use crate::dump::{self, ParameterData};
use crate::literal::Literal;
use crate::parse::{Item, Parameter, ParameterTree, ParameterValue, Text, Type, literal_type};
use crate::plan::ParameterFile;
use crate::scope::Scope;
use std::collections::BTreeMap;
use std::path::Path;
use trench_config::yaml::{self, Node};
use trench_config::{ConfigError, yaml::Value};

impl Resolver<'_> {
    /// The paths for the command line in order, and the files to write, whose parameters are for the node or pattern
    /// `key`.
    pub(super) fn parameter_files(
        &self,
        parameters: &[Parameter<'_>],
        key: &str,
        index: usize,
        scope: &Scope,
    ) -> Result<(Vec<String>, Vec<ParameterFile>), ConfigError> {
        let mut paths = Vec::new();
        let mut files = Vec::new();
        for (position, parameter) in parameters.iter().enumerate() {
            match parameter {
                Parameter::File(text) => paths.push(existing_file(text, scope)?),
                Parameter::Inline(tree) => {
                    let data = BTreeMap::from([named(tree, scope)?]);
                    let path = self.request.parameter_folder.join(format!("{index}-{}.yaml", position + 1));
                    paths.push(path.display().to_string());
                    files.push(ParameterFile { path, text: dump::parameter_file(key, &data) });
                }
            }
        }
        Ok((paths, files))
    }
}

/// The path of a parameter file, which must be there and be YAML. (The real launcher goes on without a missing file;
/// a robot must not drive with half of its parameters.)
fn existing_file(text: &Text<'_>, scope: &Scope) -> Result<String, ConfigError> {
    let path = text.perform(scope)?;
    yaml::parse(&path, &read(Path::new(&path), Some(text.node))?)?;
    Ok(path)
}

fn named(tree: &ParameterTree<'_>, scope: &Scope) -> Result<(String, ParameterData), ConfigError> {
    let name = tree.name.perform(scope)?;
    let data = match &tree.value {
        ParameterValue::Scalar(item, kind) => value(item, *kind, scope)?,
        ParameterValue::List(node, items) => list(node, items, scope)?,
        ParameterValue::Group(trees) => {
            ParameterData::Group(trees.iter().map(|tree| named(tree, scope)).collect::<Result<_, _>>()?)
        }
    };
    Ok((name, data))
}

/// A value as written, or what a text with substitutions becomes when it is read as YAML.
fn value(item: &Item<'_>, kind: Option<Type>, scope: &Scope) -> Result<ParameterData, ConfigError> {
    let (text, node) = match item {
        Item::Literal(literal) => return Ok(ParameterData::Scalar(literal.clone())),
        Item::Text(text) => (text.perform(scope)?, text.node),
    };
    let error =
        |problem: String| node.error(problem, "give a value that YAML reads as a number, boolean, text or list");
    if kind == Some(Type::Text) || text.is_empty() {
        return Ok(ParameterData::Scalar(Literal::Text(text)));
    }
    let read = yaml::parse("substituted", &text).map_err(|_| error(format!("`{text}` is not valid YAML")))?;
    let data = match &read.value {
        Value::Scalar { .. } => Literal::of(&read).map(ParameterData::Scalar),
        Value::List(nodes) => uniform(nodes.iter().map(Literal::of).collect()),
        Value::Map(_) => None,
    };
    match data {
        None | Some(ParameterData::Scalar(Literal::Null)) => {
            Err(error(format!("`{text}` is no value for a parameter")))
        }
        Some(ParameterData::Scalar(Literal::Int(number))) if kind == Some(Type::Float) => {
            Ok(ParameterData::Scalar(Literal::Float(number as f64)))
        }
        Some(ParameterData::Scalar(literal)) if kind.is_some() && literal_type(&literal) != kind => {
            Err(error(format!("`{text}` is not of the type given")))
        }
        Some(data) => Ok(data),
    }
}

fn list(node: &Node, items: &[Item<'_>], scope: &Scope) -> Result<ParameterData, ConfigError> {
    let literals = items
        .iter()
        .map(|item| match value(item, None, scope)? {
            ParameterData::Scalar(literal) => Ok(Some(literal)),
            ParameterData::List(_) | ParameterData::Group(_) => Ok(None),
        })
        .collect::<Result<_, ConfigError>>()?;
    uniform(literals).ok_or_else(|| node.error("mixes types", "write elements of one type, real numbers with a point"))
}

/// A list, if all its elements are of one type.
fn uniform(literals: Option<Vec<Literal>>) -> Option<ParameterData> {
    let literals = literals?;
    let same = literals.iter().all(|literal| literal.same_type(&literals[0]) && *literal != Literal::Null);
    same.then_some(ParameterData::List(literals))
}
