//! CDR to values, led by a schema.

use super::Value;
use super::schema::{Element, Member, Schema, Structure};
use crate::cdr::{CdrError, ReadCdr, Reader, read_bounded_string};
use crate::definition::{Primitive, Shape};

/// Why bytes are not of the type, and where.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{path}: {source}")]
pub struct DecodeError {
    /// The field, for example `robots[2].pose.x`.
    pub path: String,
    /// What is wrong there.
    pub source: CdrError,
}

impl Schema {
    /// Reads a message with its encapsulation header. Bytes behind the message are ignored.
    ///
    /// # Errors
    /// When the bytes are not of this type.
    pub fn decode(&self, cdr: &[u8]) -> Result<Value, DecodeError> {
        let mut reader = Reader::new(cdr).map_err(|source| DecodeError { path: String::new(), source })?;
        self.structures.last().map_or(Ok(Value::Message(Vec::new())), |root| self.message(root, &mut reader))
    }

    fn message(&self, structure: &Structure, reader: &mut Reader) -> Result<Value, DecodeError> {
        let at = |member: &Member| member.name.to_string();
        let first = || structure.fields.first().map(at).unwrap_or_default();
        // Early, so that a definition whose smallest value is astronomically large costs nothing.
        reader.require(structure.smallest, "the message").map_err(|source| DecodeError { path: first(), source })?;
        if structure.fields.is_empty() {
            u8::read(reader, "the byte of an empty message")
                .map_err(|source| DecodeError { path: String::new(), source })?;
        }
        let mut fields = Vec::with_capacity(structure.fields.len());
        for member in &structure.fields {
            let value = self.field(member, reader).map_err(|error| DecodeError {
                path: format!("{}{}{}", member.name, separator(&error.path), error.path),
                source: error.source,
            })?;
            fields.push((member.name.clone(), value));
        }
        Ok(Value::Message(fields))
    }

    fn field(&self, member: &Member, reader: &mut Reader) -> Result<Value, DecodeError> {
        let here = |source| DecodeError { path: String::new(), source };
        let count = match member.shape {
            Shape::Single => return self.element(member, reader),
            Shape::Array(length) => length,
            Shape::Sequence => reader.length(member.smallest, "a sequence").map_err(here)?,
            Shape::Bounded(bound) => match reader.length(member.smallest, "a sequence").map_err(here)? {
                length if length > bound => {
                    return Err(here(CdrError::Bound { field: "a sequence", length, bound }));
                }
                length => length,
            },
        };
        if let Element::Primitive(Primitive::Byte | Primitive::UInt8) = member.element {
            return Ok(Value::Bytes(reader.take(count, "bytes").map_err(here)?.to_vec()));
        }
        reader.require(count.saturating_mul(member.smallest), "an array").map_err(here)?;
        let mut values = Vec::with_capacity(count);
        for index in 0..count {
            values.push(self.element(member, reader).map_err(|error| DecodeError {
                path: format!("[{index}]{}{}", separator(&error.path), error.path),
                source: error.source,
            })?);
        }
        Ok(Value::List(values))
    }

    fn element(&self, member: &Member, reader: &mut Reader) -> Result<Value, DecodeError> {
        let here = |source| DecodeError { path: String::new(), source };
        match member.element {
            Element::Structure(index) => self.message(&self.structures[index], reader),
            Element::Text { bound } => {
                let bound = bound.unwrap_or(usize::MAX);
                read_bounded_string(reader, bound, "string").map(|text| Value::Text(text.to_owned())).map_err(here)
            }
            Element::Primitive(primitive) => number(primitive, reader).map_err(here),
        }
    }
}

/// What stands between a name and the path below it.
fn separator(below: &str) -> &'static str {
    if below.is_empty() || below.starts_with('[') { "" } else { "." }
}

fn number(primitive: Primitive, reader: &mut Reader) -> Result<Value, CdrError> {
    let name = primitive.name();
    Ok(match primitive {
        Primitive::Bool => Value::Bool(bool::read(reader, name)?),
        Primitive::Byte | Primitive::UInt8 => Value::Unsigned(u8::read(reader, name)?.into()),
        Primitive::UInt16 => Value::Unsigned(u16::read(reader, name)?.into()),
        Primitive::UInt32 => Value::Unsigned(u32::read(reader, name)?.into()),
        Primitive::UInt64 => Value::Unsigned(u64::read(reader, name)?),
        Primitive::Int8 => Value::Integer(i8::read(reader, name)?.into()),
        Primitive::Int16 => Value::Integer(i16::read(reader, name)?.into()),
        Primitive::Int32 => Value::Integer(i32::read(reader, name)?.into()),
        Primitive::Int64 => Value::Integer(i64::read(reader, name)?),
        Primitive::Float32 => Value::Float32(f32::read(reader, name)?),
        Primitive::Float64 => Value::Float64(f64::read(reader, name)?),
    })
}
