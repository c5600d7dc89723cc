//! How types, fields and values are spelled in Rust.

use super::Context;
use crate::Error;
use crate::definition::{Base, Definition, Field, Literal, Primitive, Shape, package_of, short_name_of};

/// `std::default::Default` of arrays ends here.
const LONGEST_DEFAULT_ARRAY: usize = 32;

/// Rust's keywords, reserved ones included, as far as they can be a field's name.
const KEYWORDS: [&str; 48] = [
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "do", "dyn", "else", "enum",
    "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "macro", "match", "mod", "move",
    "mut", "override", "priv", "pub", "ref", "return", "static", "struct", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// The module of a package.
pub(super) fn module<'a>(context: &Context, package: &'a str) -> &'a str {
    if package == context.own_package { "msg" } else { package }
}

/// `crate::geometry_msgs::Pose` of `geometry_msgs/msg/Pose`.
pub(super) fn path(context: &Context, name: &str) -> String {
    format!("crate::{}::{}", module(context, package_of(name)), short(name))
}

/// `TriggerRequest` of `std_srvs/srv/Trigger_Request`.
pub(super) fn short(name: &str) -> String {
    short_name_of(name).replace('_', "")
}

/// A field's name: `r#type` for `type`, `self_` for `self`, which cannot be written raw.
pub(super) fn field_name(name: &str) -> String {
    match name {
        "self" | "super" | "crate" => format!("{name}_"),
        _ if KEYWORDS.contains(&name) => format!("r#{name}"),
        _ => name.to_owned(),
    }
}

/// The type of a primitive.
pub(super) const fn primitive(primitive: Primitive) -> &'static str {
    match primitive {
        Primitive::Bool => "bool",
        Primitive::Byte | Primitive::UInt8 => "u8",
        Primitive::Int8 => "i8",
        Primitive::Int16 => "i16",
        Primitive::UInt16 => "u16",
        Primitive::Int32 => "i32",
        Primitive::UInt32 => "u32",
        Primitive::Int64 => "i64",
        Primitive::UInt64 => "u64",
        Primitive::Float32 => "f32",
        Primitive::Float64 => "f64",
    }
}

/// The owned type of a field.
pub(super) fn owned(context: &Context, definition: &Definition, field: &Field) -> Result<String, Error> {
    let unsupported = |what| Error::Unsupported { name: format!("{}.{}", definition.name, field.name), what };
    let element = match &field.base {
        Base::Primitive(base) => primitive(*base).to_owned(),
        Base::String { bound: Some(_) } if field.shape != Shape::Single => {
            return Err(unsupported("a sequence of bounded strings"));
        }
        Base::String { .. } => "::std::string::String".to_owned(),
        Base::WideString { .. } => return Err(unsupported("a wstring")),
        Base::Nested(name) => path(context, name),
    };
    Ok(match field.shape {
        Shape::Single => element,
        Shape::Array(length) => format!("[{element}; {length}]"),
        Shape::Sequence | Shape::Bounded(_) => format!("::std::vec::Vec<{element}>"),
    })
}

/// A value of a constant or default.
pub(super) fn literal(value: &Literal) -> String {
    match value {
        Literal::Bool(value) => value.to_string(),
        Literal::Integer(value) => value.to_string(),
        Literal::Float(value) => format!("{value:?}"),
        Literal::Text(text) => format!("{text:?}"),
        Literal::List(values) => format!("[{}]", values.iter().map(literal).collect::<Vec<_>>().join(", ")),
    }
}

/// The expression of a field's first value.
pub(super) fn default(field: &Field) -> String {
    match (&field.default, field.shape) {
        (Some(Literal::Text(text)), _) => format!("{text:?}.to_owned()"),
        (Some(Literal::List(values)), shape) => {
            let text = matches!(field.base, Base::String { .. });
            let owned = |value| if text { format!("{}.to_owned()", literal(value)) } else { literal(value) };
            let list = values.iter().map(owned).collect::<Vec<_>>().join(", ");
            if matches!(shape, Shape::Array(_)) { format!("[{list}]") } else { format!("vec![{list}]") }
        }
        (Some(value), _) => literal(value),
        (None, Shape::Array(_)) => "::std::array::from_fn(|_| ::std::default::Default::default())".to_owned(),
        (None, _) => "::std::default::Default::default()".to_owned(),
    }
}

/// Whether `#[derive(Default)]` gives what the definition says.
pub(super) fn default_is_derivable(definition: &Definition) -> bool {
    definition.fields.iter().all(|field| {
        let short = !matches!(field.shape, Shape::Array(length) if length > LONGEST_DEFAULT_ARRAY);
        short && field.default.as_ref().is_none_or(|value| is_zero(value, field.shape))
    })
}

/// Whether a value is what Rust's `Default` gives.
fn is_zero(value: &Literal, shape: Shape) -> bool {
    match value {
        Literal::Bool(value) => !value,
        Literal::Integer(value) => *value == 0,
        Literal::Float(value) => value.to_bits() == 0,
        Literal::Text(text) => text.is_empty(),
        Literal::List(values) => match shape {
            Shape::Array(_) => values.iter().all(|value| is_zero(value, Shape::Single)),
            _ => values.is_empty(),
        },
    }
}
