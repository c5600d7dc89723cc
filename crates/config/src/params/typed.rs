//! From YAML to one of ROS 2's parameter types.

use crate::yaml::{self, Node, Scalar, Value};
use crate::{ConfigError, Origin, ParameterValue};

/// Parses the value of a `-p name:=value`. `None` is an empty list, which has no type of its own.
///
/// # Errors
/// When it is empty, no YAML, a map or a mixed list.
pub fn parse_value(name: &str, text: &str) -> Result<Option<ParameterValue>, ConfigError> {
    let on_command_line = |mut error: ConfigError| {
        error.origin = Origin::new("command line", 0);
        name.clone_into(&mut error.key);
        error
    };
    let node = yaml::parse("command line", text).map_err(on_command_line)?;
    value(&node, name).map_err(on_command_line)
}

/// The value of the parameter `name` at `node`; `None` for an empty list.
pub(super) fn value(node: &Node, name: &str) -> Result<Option<ParameterValue>, ConfigError> {
    let result = match &node.value {
        Value::Map(_) => Err(node.unexpected("a value or a list of values")),
        Value::Scalar { .. } => scalar(node).map(Some),
        Value::List(items) => {
            items.iter().map(scalar).collect::<Result<Vec<_>, _>>().and_then(|values| list(node, values))
        }
    };
    // The key a user knows is the parameter's name, not its path from the root of the file.
    result.map_err(|error| ConfigError { key: name.to_owned(), ..error })
}

fn scalar(node: &Node) -> Result<ParameterValue, ConfigError> {
    if node.is_empty() {
        return Err(node.unexpected("a value"));
    }
    match node.scalar() {
        Some(Scalar::Bool(value)) => Ok(ParameterValue::Bool(value)),
        Some(Scalar::Integer(value)) => Ok(ParameterValue::Integer(value)),
        Some(Scalar::Double(value)) => Ok(ParameterValue::Double(value)),
        Some(Scalar::String(value)) => Ok(ParameterValue::String(value.to_owned())),
        None => Err(node.unexpected("a single value: ROS 2 knows no lists of lists")),
    }
}

/// A list of scalars of one type.
fn list(node: &Node, values: Vec<ParameterValue>) -> Result<Option<ParameterValue>, ConfigError> {
    let mut array = match values.first() {
        None => return Ok(None),
        Some(ParameterValue::Bool(_)) => ParameterValue::BoolArray(Vec::new()),
        Some(ParameterValue::Integer(_)) => ParameterValue::IntegerArray(Vec::new()),
        Some(ParameterValue::Double(_)) => ParameterValue::DoubleArray(Vec::new()),
        Some(_) => ParameterValue::StringArray(Vec::new()),
    };
    let mut has_integer = false;
    let mut has_double = false;
    for value in values {
        has_integer |= matches!(value, ParameterValue::Integer(_));
        has_double |= matches!(value, ParameterValue::Double(_));
        match (&mut array, value) {
            (ParameterValue::BoolArray(items), ParameterValue::Bool(item)) => items.push(item),
            (ParameterValue::IntegerArray(items), ParameterValue::Integer(item)) => items.push(item),
            (ParameterValue::DoubleArray(items), ParameterValue::Double(item)) => items.push(item),
            (ParameterValue::StringArray(items), ParameterValue::String(item)) => items.push(item),
            _ if has_integer && has_double => {
                return Err(node.error("mixes integers and doubles", "write a decimal point in each element"));
            }
            _ => return Err(node.error("mixes types", "write elements of one type")),
        }
    }
    Ok(Some(array))
}

/// An empty list of the type of `declared`, if that is a list.
pub(super) fn empty_list(declared: &ParameterValue) -> Option<ParameterValue> {
    match declared {
        ParameterValue::ByteArray(_) => Some(ParameterValue::ByteArray(Vec::new())),
        ParameterValue::BoolArray(_) => Some(ParameterValue::BoolArray(Vec::new())),
        ParameterValue::IntegerArray(_) => Some(ParameterValue::IntegerArray(Vec::new())),
        ParameterValue::DoubleArray(_) => Some(ParameterValue::DoubleArray(Vec::new())),
        ParameterValue::StringArray(_) => Some(ParameterValue::StringArray(Vec::new())),
        ParameterValue::Bool(_)
        | ParameterValue::Integer(_)
        | ParameterValue::Double(_)
        | ParameterValue::String(_) => None,
    }
}
