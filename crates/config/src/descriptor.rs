//! What a node declares.

use crate::{ConfigError, Origin, ParameterValue};

/// A parameter that a node declares.
///
/// ```
/// # use trench_config::ParameterDescriptor;
/// let k1 = ParameterDescriptor::double("gains.k1", 0.1, "1/s, gain K1 of (3.13)").range(0.0, 10.0).read_only();
/// assert!(k1.read_only);
/// ```
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
    /// Smallest and largest value of a number, or of each number of a list.
    pub range: Option<(f64, f64)>,
}

impl ParameterDescriptor {
    fn new(name: &'static str, default: ParameterValue, description: &'static str) -> Self {
        Self { name, default, description, read_only: false, range: None }
    }

    /// A switch.
    #[must_use]
    pub fn bool(name: &'static str, default: bool, description: &'static str) -> Self {
        Self::new(name, ParameterValue::Bool(default), description)
    }

    /// A whole number.
    #[must_use]
    pub fn integer(name: &'static str, default: i64, description: &'static str) -> Self {
        Self::new(name, ParameterValue::Integer(default), description)
    }

    /// A real number.
    #[must_use]
    pub fn double(name: &'static str, default: f64, description: &'static str) -> Self {
        Self::new(name, ParameterValue::Double(default), description)
    }

    /// A text.
    #[must_use]
    pub fn string(name: &'static str, default: &str, description: &'static str) -> Self {
        Self::new(name, ParameterValue::String(default.to_owned()), description)
    }

    /// A list of switches.
    #[must_use]
    pub fn bool_list(name: &'static str, default: &[bool], description: &'static str) -> Self {
        Self::new(name, ParameterValue::BoolArray(default.to_vec()), description)
    }

    /// A list of whole numbers.
    #[must_use]
    pub fn integer_list(name: &'static str, default: &[i64], description: &'static str) -> Self {
        Self::new(name, ParameterValue::IntegerArray(default.to_vec()), description)
    }

    /// A list of real numbers.
    #[must_use]
    pub fn double_list(name: &'static str, default: &[f64], description: &'static str) -> Self {
        Self::new(name, ParameterValue::DoubleArray(default.to_vec()), description)
    }

    /// A list of texts.
    #[must_use]
    pub fn string_list(name: &'static str, default: &[&str], description: &'static str) -> Self {
        let default = default.iter().map(|text| (*text).to_owned()).collect();
        Self::new(name, ParameterValue::StringArray(default), description)
    }

    /// Limits a number, or each number of a list, to `smallest..=largest`.
    #[must_use]
    pub fn range(mut self, smallest: f64, largest: f64) -> Self {
        self.range = Some((smallest, largest));
        self
    }

    /// Fixes the value once the node runs.
    #[must_use]
    pub fn read_only(mut self) -> Self {
        self.read_only = true;
        self
    }

    /// Whether `value`, written at `origin`, may be this parameter's: type, finite numbers, range. A change while the
    /// node runs must also respect [`Self::read_only`], which is for the caller to look at.
    ///
    /// # Errors
    /// When it may not.
    pub fn check(&self, value: &ParameterValue, origin: &Origin) -> Result<(), ConfigError> {
        let error = |problem: String, remedy: String| ConfigError {
            origin: origin.clone(),
            key: self.name.to_owned(),
            value: value.to_string(),
            problem,
            remedy,
        };
        if !self.default.same_type(value) {
            let problem = format!("is of type {}, declared as {}", value.type_name(), self.default.type_name());
            return Err(error(problem, self.type_remedy(value)));
        }
        for number in value.numbers() {
            if !number.is_finite() {
                return Err(error("is not a finite number".to_owned(), "write a finite one".to_owned()));
            }
            if let Some((smallest, largest)) = self.range
                && !(smallest..=largest).contains(&number)
            {
                let remedy = format!("write a value from {smallest} to {largest}");
                return Err(error("is out of range".to_owned(), remedy));
            }
        }
        Ok(())
    }

    /// How to write `value` so that it has the declared type.
    fn type_remedy(&self, value: &ParameterValue) -> String {
        use ParameterValue::{Double, DoubleArray, Integer, IntegerArray, String};
        match (&self.default, value) {
            (Double(_), Integer(number)) => format!("write {:?}", *number as f64),
            (DoubleArray(_), IntegerArray(numbers)) => {
                format!("write {}", DoubleArray(numbers.iter().map(|number| *number as f64).collect()))
            }
            (String(_), Integer(_) | Double(_) | ParameterValue::Bool(_)) => format!("write \"{value}\" in quotes"),
            (Integer(_), Double(number)) if number.fract() == 0.0 && number.abs() < 1e15 => {
                format!("write {}", *number as i64)
            }
            _ => format!("write {}, for example {}", self.default.type_with_article(), self.default),
        }
    }
}
