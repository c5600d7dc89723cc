//! Decoded values and the paths to them.

use std::fmt;
use std::sync::Arc;

/// A value of any type.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// `bool`.
    Bool(bool),
    /// Signed integers.
    Integer(i64),
    /// Unsigned integers and `byte`.
    Unsigned(u64),
    /// `float32`, kept as such so that it prints as it was meant.
    Float32(f32),
    /// `float64`.
    Float64(f64),
    /// `string`.
    Text(String),
    /// Arrays and sequences of `uint8`, `byte` or `char`.
    Bytes(Vec<u8>),
    /// Other arrays and sequences.
    List(Vec<Value>),
    /// A message: names and values in the order of its definition.
    Message(Vec<(Arc<str>, Value)>),
}

impl Value {
    /// What is at a path such as `robots[2].pose.x`; the empty path is the value itself. Single bytes of
    /// [`Value::Bytes`] have no path.
    #[must_use]
    pub fn get(&self, path: &str) -> Option<&Self> {
        let path = path.strip_prefix('.').unwrap_or(path);
        if path.is_empty() {
            return Some(self);
        }
        if let Some(rest) = path.strip_prefix('[') {
            let (index, rest) = rest.split_once(']')?;
            let Self::List(values) = self else { return None };
            return values.get(index.parse::<usize>().ok()?)?.get(rest);
        }
        let (name, rest) = path.split_at(path.find(['.', '[']).unwrap_or(path.len()));
        let Self::Message(fields) = self else { return None };
        fields.iter().find(|(field, _)| **field == *name)?.1.get(rest)
    }

    /// A number or boolean (0 or 1) as `f64`; integers beyond 2^53 are rounded.
    #[must_use]
    pub fn as_f64(&self) -> Option<f64> {
        match self {
            Self::Bool(value) => Some(f64::from(u8::from(*value))),
            Self::Integer(value) => Some(*value as f64),
            Self::Unsigned(value) => Some(*value as f64),
            Self::Float32(value) => Some(f64::from(*value)),
            Self::Float64(value) => Some(*value),
            Self::Text(_) | Self::Bytes(_) | Self::List(_) | Self::Message(_) => None,
        }
    }

    /// The text of a `string`.
    #[must_use]
    pub fn as_str(&self) -> Option<&str> {
        match self {
            Self::Text(text) => Some(text),
            _ => None,
        }
    }

    /// All values that hold no others, with their paths, in the order of the definition; empty lists are among them.
    #[must_use]
    pub fn leaves(&self) -> Vec<(String, &Self)> {
        let mut leaves = Vec::new();
        self.collect_leaves(String::new(), &mut leaves);
        leaves
    }

    fn collect_leaves<'a>(&'a self, path: String, leaves: &mut Vec<(String, &'a Self)>) {
        match self {
            Self::Message(fields) if !fields.is_empty() => {
                let separator = if path.is_empty() { "" } else { "." };
                for (name, value) in fields {
                    value.collect_leaves(format!("{path}{separator}{name}"), leaves);
                }
            }
            Self::List(values) if !values.is_empty() => {
                for (index, value) in values.iter().enumerate() {
                    value.collect_leaves(format!("{path}[{index}]"), leaves);
                }
            }
            _ => leaves.push((path, self)),
        }
    }
}

/// One line in YAML's flow style; of bytes only their number.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bool(value) => write!(f, "{value}"),
            Self::Integer(value) => write!(f, "{value}"),
            Self::Unsigned(value) => write!(f, "{value}"),
            // As Rust writes it: 1.0 is not taken for an integer.
            Self::Float32(value) => write!(f, "{value:?}"),
            Self::Float64(value) => write!(f, "{value:?}"),
            Self::Text(text) => write!(f, "{text:?}"),
            Self::Bytes(bytes) => write!(f, "<{} bytes>", bytes.len()),
            Self::List(values) => {
                let texts: Vec<String> = values.iter().map(Self::to_string).collect();
                write!(f, "[{}]", texts.join(", "))
            }
            Self::Message(fields) => {
                let texts: Vec<String> = fields.iter().map(|(name, value)| format!("{name}: {value}")).collect();
                write!(f, "{{{}}}", texts.join(", "))
            }
        }
    }
}
