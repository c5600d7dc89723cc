//! Nodes and how to read them.

use super::{FromNode, Map, Scalar};
use crate::{ConfigError, Origin};

/// A value with its place in the file.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The value.
    pub value: Value,
    /// File and line.
    pub origin: Origin,
    /// The full key, for example `queues[2].share`; empty at the root.
    pub path: String,
}

/// What a node holds.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A scalar as written, without quotes and escapes.
    Scalar {
        /// The text.
        text: String,
        /// Whether it stood without quotes (and without `!!str`), so that it may be a number or a boolean.
        plain: bool,
    },
    /// A list.
    List(Vec<Node>),
    /// A map, in the order of the file.
    Map(Vec<Entry>),
}

/// A key of a map and its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// Where the key stands.
    pub origin: Origin,
    /// The value.
    pub node: Node,
}

impl Node {
    /// Reads it as a `T`.
    ///
    /// # Errors
    /// When it is not one.
    pub fn get<T: FromNode>(&self) -> Result<T, ConfigError> {
        T::from_node(self)
    }

    /// Reads it as a map.
    ///
    /// # Errors
    /// When it is not one.
    pub fn map(&self) -> Result<Map<'_>, ConfigError> {
        match &self.value {
            Value::Map(entries) => Ok(Map::new(self, entries)),
            Value::Scalar { .. } | Value::List(_) => Err(self.unexpected("a map (key: value)")),
        }
    }

    /// Reads it as a list.
    ///
    /// # Errors
    /// When it is not one.
    pub fn list(&self) -> Result<&[Self], ConfigError> {
        match &self.value {
            Value::List(nodes) => Ok(nodes),
            Value::Scalar { .. } | Value::Map(_) => Err(self.unexpected("a list")),
        }
    }

    /// Reads it as a text. Numbers and booleans need quotes to be texts.
    ///
    /// # Errors
    /// When it is not one.
    pub fn str(&self) -> Result<&str, ConfigError> {
        match self.scalar() {
            Some(Scalar::String(text)) if !self.is_empty() => Ok(text),
            Some(Scalar::Bool(_) | Scalar::Integer(_) | Scalar::Double(_)) => Err(self.unexpected("a text in quotes")),
            Some(Scalar::String(_)) | None => Err(self.unexpected("a text")),
        }
    }

    /// The resolved scalar, if it is one.
    #[must_use]
    pub fn scalar(&self) -> Option<Scalar<'_>> {
        match &self.value {
            Value::Scalar { text, plain } => Some(Scalar::resolve(text, *plain)),
            Value::List(_) | Value::Map(_) => None,
        }
    }

    /// Whether nothing was written: `key:` without a value.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        matches!(&self.value, Value::Scalar { text, plain: true } if text.is_empty())
    }

    /// An error about this value.
    #[must_use]
    pub fn error(&self, problem: impl Into<String>, remedy: impl Into<String>) -> ConfigError {
        let value = match &self.value {
            Value::Scalar { text, plain: true } => text.clone(),
            Value::Scalar { text, plain: false } => format!("{text:?}"),
            Value::List(_) | Value::Map(_) => String::new(),
        };
        ConfigError {
            origin: self.origin.clone(),
            key: self.path.clone(),
            value,
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }

    /// An error that says what it is and what was expected.
    pub(crate) fn unexpected(&self, expected: &str) -> ConfigError {
        let actual = match (&self.value, self.scalar()) {
            (Value::List(_), _) => "is a list",
            (Value::Map(_), _) => "is a map",
            _ if self.is_empty() => "has no value",
            (_, Some(Scalar::Bool(_))) => "is a boolean",
            (_, Some(Scalar::Integer(_))) => "is an integer",
            (_, Some(Scalar::Double(_))) => "is a real number",
            (_, Some(Scalar::String(_)) | None) => "is a text",
        };
        self.error(actual, format!("write {expected}"))
    }
}
