//! Parameter values and descriptors as rcl_interfaces' messages say them.

use trench_config::{ParameterDescriptor, ParameterValue};
use trench_msgs::rcl_interfaces as message;
use trench_msgs::rcl_interfaces::ParameterType as Kind;

/// The number of a value's type.
pub(super) fn kind(value: &ParameterValue) -> u8 {
    match value {
        ParameterValue::Bool(_) => Kind::PARAMETER_BOOL,
        ParameterValue::Integer(_) => Kind::PARAMETER_INTEGER,
        ParameterValue::Double(_) => Kind::PARAMETER_DOUBLE,
        ParameterValue::String(_) => Kind::PARAMETER_STRING,
        ParameterValue::ByteArray(_) => Kind::PARAMETER_BYTE_ARRAY,
        ParameterValue::BoolArray(_) => Kind::PARAMETER_BOOL_ARRAY,
        ParameterValue::IntegerArray(_) => Kind::PARAMETER_INTEGER_ARRAY,
        ParameterValue::DoubleArray(_) => Kind::PARAMETER_DOUBLE_ARRAY,
        ParameterValue::StringArray(_) => Kind::PARAMETER_STRING_ARRAY,
    }
}

/// A value as a message.
#[must_use]
pub fn to_message(value: &ParameterValue) -> message::ParameterValue {
    let mut said = message::ParameterValue { r#type: kind(value), ..Default::default() };
    match value.clone() {
        ParameterValue::Bool(value) => said.bool_value = value,
        ParameterValue::Integer(value) => said.integer_value = value,
        ParameterValue::Double(value) => said.double_value = value,
        ParameterValue::String(value) => said.string_value = value,
        ParameterValue::ByteArray(values) => said.byte_array_value = values,
        ParameterValue::BoolArray(values) => said.bool_array_value = values,
        ParameterValue::IntegerArray(values) => said.integer_array_value = values,
        ParameterValue::DoubleArray(values) => said.double_array_value = values,
        ParameterValue::StringArray(values) => said.string_array_value = values,
    }
    said
}

/// The value that a message says; `None` for "not set" and for types that do not exist.
pub(super) fn from_message(said: message::ParameterValue) -> Option<ParameterValue> {
    Some(match said.r#type {
        Kind::PARAMETER_BOOL => ParameterValue::Bool(said.bool_value),
        Kind::PARAMETER_INTEGER => ParameterValue::Integer(said.integer_value),
        Kind::PARAMETER_DOUBLE => ParameterValue::Double(said.double_value),
        Kind::PARAMETER_STRING => ParameterValue::String(said.string_value),
        Kind::PARAMETER_BYTE_ARRAY => ParameterValue::ByteArray(said.byte_array_value),
        Kind::PARAMETER_BOOL_ARRAY => ParameterValue::BoolArray(said.bool_array_value),
        Kind::PARAMETER_INTEGER_ARRAY => ParameterValue::IntegerArray(said.integer_array_value),
        Kind::PARAMETER_DOUBLE_ARRAY => ParameterValue::DoubleArray(said.double_array_value),
        Kind::PARAMETER_STRING_ARRAY => ParameterValue::StringArray(said.string_array_value),
        _ => return None,
    })
}

/// What is declared, as a message.
pub(super) fn describe(declared: &ParameterDescriptor) -> message::ParameterDescriptor {
    let mut said = message::ParameterDescriptor {
        name: declared.name.to_owned(),
        r#type: kind(&declared.default),
        description: declared.description.to_owned(),
        read_only: declared.read_only,
        ..Default::default()
    };
    match (&declared.default, declared.range) {
        (ParameterValue::Double(_), Some((from_value, to_value))) => {
            said.floating_point_range = vec![message::FloatingPointRange { from_value, to_value, step: 0.0 }];
        }
        (ParameterValue::Integer(_), Some((smallest, largest))) => {
            // Ranges are declared as doubles; whole numbers as large as a range's end are exact there.
            let (from_value, to_value) = (smallest.ceil() as i64, largest.floor() as i64);
            said.integer_range = vec![message::IntegerRange { from_value, to_value, step: 0 }];
        }
        (_, Some((smallest, largest))) => {
            said.additional_constraints = format!("each number from {smallest} to {largest}");
        }
        (_, None) => {}
    }
    said
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_type_survives_the_way_there_and_back() {
        for value in [
            ParameterValue::Bool(true),
            ParameterValue::Integer(-3),
            ParameterValue::Double(0.5),
            ParameterValue::String("a".to_owned()),
            ParameterValue::ByteArray(vec![1, 2]),
            ParameterValue::BoolArray(vec![true, false]),
            ParameterValue::IntegerArray(vec![]),
            ParameterValue::DoubleArray(vec![1.0]),
            ParameterValue::StringArray(vec!["b".to_owned()]),
        ] {
            assert_eq!(from_message(to_message(&value)), Some(value));
        }
        let unknown = message::ParameterValue { r#type: 200, ..Default::default() };
        assert_eq!(from_message(unknown), None);
    }
}
