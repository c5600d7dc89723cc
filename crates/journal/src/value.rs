//! Parameter values in a journal.

use serde::{Deserialize, Serialize};
use trench_config::ParameterValue;

/// Mirrors [`ParameterValue`], which knows no serialisation. The order is part of the format.
#[derive(Serialize, Deserialize)]
#[serde(remote = "ParameterValue")]
pub(crate) enum ValueDefinition {
    Bool(bool),
    Integer(i64),
    Double(f64),
    String(String),
    ByteArray(Vec<u8>),
    BoolArray(Vec<bool>),
    IntegerArray(Vec<i64>),
    DoubleArray(Vec<f64>),
    StringArray(Vec<String>),
}
