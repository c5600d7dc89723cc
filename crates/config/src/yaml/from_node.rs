//! Types that can be read from a node.

use super::{Node, Scalar};
use crate::ConfigError;

/// A type that a node can be read as.
pub trait FromNode: Sized {
    /// Reads it.
    ///
    /// # Errors
    /// When `node` is not one.
    fn from_node(node: &Node) -> Result<Self, ConfigError>;
}

impl FromNode for f64 {
    fn from_node(node: &Node) -> Result<Self, ConfigError> {
        match node.scalar() {
            Some(Scalar::Integer(value)) => Ok(value as Self),
            Some(Scalar::Double(value)) if value.is_finite() => Ok(value),
            Some(Scalar::Double(_)) => Err(node.error("is not finite", "write a finite number")),
            _ => Err(node.unexpected("a number")),
        }
    }
}

impl FromNode for i64 {
    fn from_node(node: &Node) -> Result<Self, ConfigError> {
        match node.scalar() {
            Some(Scalar::Integer(value)) => Ok(value),
            _ => Err(node.unexpected("an integer")),
        }
    }
}

impl FromNode for bool {
    fn from_node(node: &Node) -> Result<Self, ConfigError> {
        match node.scalar() {
            Some(Scalar::Bool(value)) => Ok(value),
            _ => Err(node.unexpected("true or false")),
        }
    }
}

impl FromNode for String {
    fn from_node(node: &Node) -> Result<Self, ConfigError> {
        node.str().map(str::to_owned)
    }
}

/// Integers of a smaller range.
macro_rules! from_integer {
    ($($type:ty),*) => {
        $(impl FromNode for $type {
            fn from_node(node: &Node) -> Result<Self, ConfigError> {
                <$type>::try_from(node.get::<i64>()?).map_err(|_| {
                    node.error("is out of range", format!("write an integer from {} to {}", <$type>::MIN, <$type>::MAX))
                })
            }
        })*
    };
}
from_integer!(u8, u16, u32, i32, u64, usize);

impl<T: FromNode> FromNode for Vec<T> {
    fn from_node(node: &Node) -> Result<Self, ConfigError> {
        node.list()?.iter().map(Node::get).collect()
    }
}

impl<T: FromNode, const N: usize> FromNode for [T; N] {
    fn from_node(node: &Node) -> Result<Self, ConfigError> {
        let items: Vec<T> = node.get()?;
        let count = items.len();
        Self::try_from(items).map_err(|_| node.error(format!("has {count} elements"), format!("write {N}")))
    }
}
