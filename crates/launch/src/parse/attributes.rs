//! Reading the keys of an action with the strict types of the real `ros2 launch`: a text must be a text (numbers and
//! booleans in quotes), a real number must have a point.

use crate::literal::Literal;
use crate::scope::Scope;
use crate::substitution::Template;
use std::time::Duration;
use trench_config::ConfigError;
use trench_config::yaml::{Map, Node};

/// A text with substitutions, and where it stands.
#[derive(Debug, Clone)]
pub(crate) struct Text<'a> {
    pub(crate) template: Template,
    pub(crate) node: &'a Node,
}

impl<'a> Text<'a> {
    pub(crate) fn parse(node: &'a Node) -> Result<Self, ConfigError> {
        let text = plain_text(node)?;
        let template =
            Template::parse(&text).map_err(|problem| node.error(problem, "write substitutions as $(name argument)"))?;
        Ok(Self { template, node })
    }

    /// The text with the substitutions made.
    pub(crate) fn perform(&self, scope: &Scope) -> Result<String, ConfigError> {
        self.template.perform(scope).map_err(|failure| self.node.error(failure.problem, failure.remedy))
    }
}

/// The text at `node` as it stands.
pub(super) fn plain_text(node: &Node) -> Result<String, ConfigError> {
    match Literal::of(node) {
        Some(Literal::Text(text)) => Ok(text),
        Some(Literal::Null) => Err(node.error("has no value", "write a text")),
        Some(other) => Err(node.error(other.kind(), "write a text, in quotes")),
        None => Err(node.error("is not a single value", "write a text")),
    }
}

pub(super) fn text<'a>(map: &Map<'a>, key: &str) -> Result<Text<'a>, ConfigError> {
    Text::parse(map.node(key)?)
}

pub(super) fn opt_text<'a>(map: &Map<'a>, key: &str) -> Result<Option<Text<'a>>, ConfigError> {
    map.opt_node(key).map(Text::parse).transpose()
}

pub(super) fn opt_plain_text(map: &Map<'_>, key: &str) -> Result<Option<String>, ConfigError> {
    map.opt_node(key).map(plain_text).transpose()
}

pub(super) fn opt_bool(map: &Map<'_>, key: &str) -> Result<Option<bool>, ConfigError> {
    let Some(node) = map.opt_node(key) else { return Ok(None) };
    match Literal::of(node) {
        Some(Literal::Bool(value)) => Ok(Some(value)),
        _ => Err(node.error("is not a boolean", "write true or false, without quotes")),
    }
}

pub(super) fn opt_count(map: &Map<'_>, key: &str) -> Result<Option<i64>, ConfigError> {
    let Some(node) = map.opt_node(key) else { return Ok(None) };
    match Literal::of(node) {
        Some(Literal::Int(value)) => Ok(Some(value)),
        _ => Err(node.error("is not an integer", "write an integer, without quotes")),
    }
}

pub(super) fn opt_seconds(map: &Map<'_>, key: &str) -> Result<Option<Duration>, ConfigError> {
    let Some(node) = map.opt_node(key) else { return Ok(None) };
    match Literal::of(node) {
        Some(Literal::Float(value)) => seconds(value, node).map(Some),
        Some(Literal::Int(value)) => Err(node.error("is an integer", format!("write {value}.0"))),
        _ => Err(node.error("is not a real number", "write seconds, for example 2.0")),
    }
}

/// A number of seconds that may also be a text with substitutions.
pub(super) fn seconds_text<'a>(map: &Map<'a>, key: &str) -> Result<Text<'a>, ConfigError> {
    match map.opt_node(key).and_then(Literal::of) {
        Some(Literal::Text(_)) => text(map, key),
        _ => {
            let node = map.node(key)?;
            let period = opt_seconds(map, key)?.unwrap_or_default();
            let text = crate::substitution::Part::Text(period.as_secs_f64().to_string());
            Ok(Text { template: Template(vec![text]), node })
        }
    }
}

/// The time of `value` seconds, which stands at `node`.
pub(crate) fn seconds(value: f64, node: &Node) -> Result<Duration, ConfigError> {
    Duration::try_from_secs_f64(value).map_err(|_| node.error("is no length of time", "write seconds, 0.0 or more"))
}

/// The maps of the list `key`, read by `read`; empty where the key is missing.
pub(super) fn list<'a, T>(
    map: &Map<'a>,
    key: &str,
    read: impl Fn(&Map<'a>) -> Result<T, ConfigError>,
) -> Result<Vec<T>, ConfigError> {
    let read_entry = |node: &'a Node| {
        let entry = node.map()?;
        let value = read(&entry)?;
        entry.finish()?;
        Ok(value)
    };
    map.opt_list(key)?.iter().map(read_entry).collect()
}
