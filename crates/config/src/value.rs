//! Values of parameters.

use std::fmt;

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

impl ParameterValue {
    /// The name of its type, as `ros2 param describe` says it.
    #[must_use]
    pub fn type_name(&self) -> &'static str {
        match self {
            Self::Bool(_) => "boolean",
            Self::Integer(_) => "integer",
            Self::Double(_) => "double",
            Self::String(_) => "string",
            Self::ByteArray(_) => "byte array",
            Self::BoolArray(_) => "boolean array",
            Self::IntegerArray(_) => "integer array",
            Self::DoubleArray(_) => "double array",
            Self::StringArray(_) => "string array",
        }
    }

    /// The name of its type in a sentence.
    pub(crate) fn type_with_article(&self) -> String {
        let name = self.type_name();
        format!("{} {name}", if name.starts_with('i') { "an" } else { "a" })
    }

    /// Whether both are of one type.
    #[must_use]
    pub fn same_type(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }

    /// Its numbers, where it holds any.
    #[must_use]
    pub fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Integer(value) => vec![*value as f64],
            Self::Double(value) => vec![*value],
            Self::IntegerArray(values) => values.iter().map(|value| *value as f64).collect(),
            Self::DoubleArray(values) => values.clone(),
            Self::Bool(_) | Self::String(_) | Self::ByteArray(_) | Self::BoolArray(_) | Self::StringArray(_) => {
                Vec::new()
            }
        }
    }
}

/// As a parameter file writes it.
impl fmt::Display for ParameterValue {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fn list<T>(formatter: &mut fmt::Formatter<'_>, items: &[T], text: impl Fn(&T) -> String) -> fmt::Result {
            write!(formatter, "[{}]", items.iter().map(text).collect::<Vec<_>>().join(", "))
        }
        match self {
            Self::Bool(value) => write!(formatter, "{value}"),
            Self::Integer(value) => write!(formatter, "{value}"),
            // `{:?}` keeps the decimal point that tells a double from an integer.
            Self::Double(value) => write!(formatter, "{value:?}"),
            Self::String(value) => write!(formatter, "{value:?}"),
            Self::ByteArray(values) => list(formatter, values, |value| format!("0x{value:02x}")),
            Self::BoolArray(values) => list(formatter, values, bool::to_string),
            Self::IntegerArray(values) => list(formatter, values, i64::to_string),
            Self::DoubleArray(values) => list(formatter, values, |value| format!("{value:?}")),
            Self::StringArray(values) => list(formatter, values, |value| format!("{value:?}")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::ParameterValue;

    #[test]
    fn shows_as_a_file_writes_it() {
        for (value, expected) in [
            (ParameterValue::Double(1.0), "1.0"),
            (ParameterValue::Integer(1), "1"),
            (ParameterValue::String("a b".to_owned()), "\"a b\""),
            (ParameterValue::DoubleArray(vec![0.2, 3.0]), "[0.2, 3.0]"),
            (ParameterValue::ByteArray(vec![10]), "[0x0a]"),
        ] {
            assert_eq!(value.to_string(), expected);
        }
    }
}
