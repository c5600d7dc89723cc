//! Parameters as nodes receive them.

use crate::{ConfigError, Origin, ParameterValue};
use std::collections::BTreeMap;

/// All parameters of a node with the values in force and where each came from.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Parameters {
    values: BTreeMap<String, (ParameterValue, Origin)>,
}

/// One typed getter: the declared type is guaranteed by [`crate::params::resolve`], so it fails only where the node
/// asks for another name or type than it declared.
macro_rules! getter {
    ($(#[$doc:meta])* $name:ident, $variant:ident, $wanted:literal, $result:ty, $value:ident => $convert:expr) => {
        $(#[$doc])*
        ///
        /// # Errors
        /// When no parameter of this name and type was declared.
        pub fn $name(&self, name: &str) -> Result<$result, ConfigError> {
            match self.get(name) {
                Some((ParameterValue::$variant($value), _)) => Ok($convert),
                Some((value, _)) => Err(self.error(
                    name,
                    format!("is of type {}", value.type_name()),
                    concat!("the node wants ", $wanted),
                )),
                None => Err(self.error(name, "is not declared", "the node must declare it")),
            }
        }
    };
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

    getter!(
        /// A boolean parameter.
        bool, Bool, "a boolean", bool, value => *value
    );
    getter!(
        /// An integer parameter.
        i64, Integer, "an integer", i64, value => *value
    );
    getter!(
        /// A double parameter.
        f64, Double, "a double", f64, value => *value
    );
    getter!(
        /// A string parameter.
        str, String, "a string", &str, value => value
    );
    getter!(
        /// A boolean array parameter.
        bool_list, BoolArray, "a boolean array", &[bool], value => value
    );
    getter!(
        /// An integer array parameter.
        i64_list, IntegerArray, "an integer array", &[i64], value => value
    );
    getter!(
        /// A double array parameter.
        f64_list, DoubleArray, "a double array", &[f64], value => value
    );
    getter!(
        /// A string array parameter.
        str_list, StringArray, "a string array", &[String], value => value
    );

    /// An integer parameter as a count.
    ///
    /// # Errors
    /// When no integer of this name was declared, or it is negative.
    pub fn usize(&self, name: &str) -> Result<usize, ConfigError> {
        usize::try_from(self.i64(name)?).map_err(|_| self.error(name, "is negative", "write 0 or more"))
    }

    /// A string array parameter of names.
    ///
    /// # Errors
    /// When no string array of this name was declared, or a name is empty or there twice.
    pub fn names(&self, name: &str) -> Result<&[String], ConfigError> {
        let names = self.str_list(name)?;
        for (index, each) in names.iter().enumerate() {
            if each.is_empty() {
                return Err(self.error(name, "has an empty name", "give each robot a name"));
            }
            if names[..index].contains(each) {
                return Err(self.error(name, format!("{each} is there twice"), "name each robot once"));
            }
        }
        Ok(names)
    }

    /// As [`Parameters::names`], one at least.
    ///
    /// # Errors
    /// As there, and where there is none.
    pub fn some_names(&self, name: &str) -> Result<&[String], ConfigError> {
        let names = self.names(name)?;
        if names.is_empty() {
            return Err(self.error(name, "there is no robot", format!("name them: {name}: [robot1, robot2]")));
        }
        Ok(names)
    }

    /// A double array parameter of a fixed length, such as a position.
    ///
    /// # Errors
    /// When no double array of this name was declared, or it has another length.
    pub fn f64_array<const N: usize>(&self, name: &str) -> Result<[f64; N], ConfigError> {
        let values = self.f64_list(name)?;
        <[f64; N]>::try_from(values)
            .map_err(|_| self.error(name, format!("has {} elements", values.len()), format!("write {N}")))
    }

    /// An error about `name` that says where its value came from.
    #[must_use]
    pub fn error(&self, name: &str, problem: impl Into<String>, remedy: impl Into<String>) -> ConfigError {
        let (value, origin) = match self.values.get(name) {
            Some((value, origin)) => (value.to_string(), origin.clone()),
            None => (String::new(), Origin::default()),
        };
        ConfigError { origin, key: name.to_owned(), value, problem: problem.into(), remedy: remedy.into() }
    }
}
