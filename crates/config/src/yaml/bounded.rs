//! Numbers that no length, speed or time of ours has.

use super::{Node, Scalar, Value};
use crate::ConfigError;

/// SI units; the farthest coordinate, the fastest speed. Squares and products of a few such numbers are finite, and a micrometre still
/// counts beside them.
const MOST: f64 = 1e6;

impl Node {
    /// Checks that no number in it is beyond all that robots have to do with: where one is, what is computed from it goes wrong much later,
    /// and nobody says why. For files of coordinates, lengths, speeds and times.
    ///
    /// # Errors
    /// At the first that is.
    pub fn bounded(&self) -> Result<(), ConfigError> {
        match &self.value {
            Value::List(nodes) => nodes.iter().try_for_each(Self::bounded),
            Value::Map(entries) => entries.iter().try_for_each(|entry| entry.node.bounded()),
            Value::Scalar { .. } => {
                let number = match self.scalar() {
                    Some(Scalar::Integer(value)) => value as f64,
                    Some(Scalar::Double(value)) => value,
                    _ => return Ok(()),
                };
                // What is no number at all is refused where it is read.
                if number.is_finite() && number.abs() > MOST {
                    let remedy = format!("write metres, seconds, m/s: at most {MOST}");
                    return Err(self.error("is beyond all that robots have to do with", remedy));
                }
                Ok(())
            }
        }
    }
}
