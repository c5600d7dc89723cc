//! Parameters as nodes declare and receive them.

use crate::{ConfigError, Origin};
use std::collections::BTreeMap;

/// A value of one of ROS 2's nine parameter types.
#[derive(Debug, Clone, PartialEq)]
pub enum ParameterValue {
    /// `bool`
    Bool(bool),
    /// `integer`
    Integer(i64),
    /// `double`
    Double(f64),
    /// `string`
    String(String),
    /// `byte_array`
    ByteArray(Vec<u8>),
    /// `bool_array`
    BoolArray(Vec<bool>),
    /// `integer_array`
    IntegerArray(Vec<i64>),
    /// `double_array`
    DoubleArray(Vec<f64>),
    /// `string_array`
    StringArray(Vec<String>),
}

/// A parameter that a node declares.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterDescriptor {
    /// Dotted name, for example `gains.k1`.
    pub name: &'static str,
    /// The value where none is given; it fixes the type.
    pub default: ParameterValue,
    /// What it is, with its unit.
    pub description: &'static str,
    /// Whether it is fixed once the node runs.
    pub read_only: bool,
    /// Smallest and largest value of a number.
    pub range: Option<(f64, f64)>,
}

/// All parameters of a node with the values in force and where each came from.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Parameters {
    values: BTreeMap<String, (ParameterValue, Origin)>,
}

impl Parameters {
    /// Sets a value.
    pub fn insert(&mut self, name: impl Into<String>, value: ParameterValue, origin: Origin) {
        self.values.insert(name.into(), (value, origin));
    }

    /// The value of `name` and where it came from.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<(&ParameterValue, &Origin)> {
        self.values.get(name).map(|(value, origin)| (value, origin))
    }

    /// All names and values, ordered by name.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &ParameterValue, &Origin)> {
        self.values.iter().map(|(name, (value, origin))| (name.as_str(), value, origin))
    }

    /// An error about `name` that says where its value came from.
    #[must_use]
    pub fn error(&self, name: &str, problem: impl Into<String>, remedy: impl Into<String>) -> ConfigError {
        let (value, origin) = match self.values.get(name) {
            Some((value, origin)) => (format!("{value:?}"), origin.clone()),
            None => (String::new(), Origin::default()),
        };
        ConfigError { origin, key: name.to_owned(), value, problem: problem.into(), remedy: remedy.into() }
    }
}
