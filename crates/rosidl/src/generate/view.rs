//! The borrowed form of a message: strings and bytes point into the bytes read.

use super::{Context, message, rust_type};
use crate::definition::{Base, Definition, Field, Primitive, Shape};
use crate::{Error, Library};
use std::collections::BTreeSet;

/// The messages asked for and those that they contain, as far as these hold something to borrow.
pub(super) fn closure(library: &Library, asked: &[&str]) -> Result<BTreeSet<String>, Error> {
    let mut views = BTreeSet::new();
    for name in asked {
        // Every message comes behind those that it contains.
        for definition in library.closure(name)? {
            let borrows = |field: &Field| match &field.base {
                Base::Nested(nested) => field.shape == Shape::Single && views.contains(nested),
                _ => is_borrowed(field),
            };
            if definition.fields.iter().any(borrows) {
                views.insert(definition.name.clone());
            }
        }
    }
    Ok(views)
}

fn is_borrowed(field: &Field) -> bool {
    match (&field.base, field.shape) {
        (Base::String { .. }, Shape::Single) => true,
        (Base::Primitive(primitive), Shape::Sequence) => matches!(primitive, Primitive::UInt8 | Primitive::Byte),
        _ => is_list(field),
    }
}

/// Whether the borrowed form is a list of its own, of what points into the bytes read.
fn is_list(field: &Field) -> bool {
    matches!((&field.base, field.shape), (Base::String { bound: None }, Shape::Sequence))
}

pub(super) fn generate(context: &Context, definition: &Definition) -> Result<String, Error> {
    let name = rust_type::short(&definition.name);
    let view = format!("{name}View");
    let mut types = Vec::new();
    for field in &definition.fields {
        types.push(match (&field.base, field.shape) {
            _ if is_list(field) => "::std::vec::Vec<&'a str>".to_owned(),
            (Base::String { .. }, _) if is_borrowed(field) => "&'a str".to_owned(),
            (Base::Primitive(_), _) if is_borrowed(field) => "&'a [u8]".to_owned(),
            (Base::Nested(nested), Shape::Single) if context.views.contains(nested) => {
                format!("{}View<'a>", rust_type::path(context, nested))
            }
            _ if message::is_plain_field(context, field) => rust_type::owned(context, definition, field)?,
            _ => {
                let name = format!("{}.{}", definition.name, field.name);
                let what = "a borrowed form of what is neither string, bytes nor of a fixed size";
                return Err(Error::Unsupported { name, what });
            }
        });
    }
    let is_copy = !definition.fields.iter().any(is_list);
    let mut source = message::structure(definition, &view, "<'a>", is_copy, &types);
    source += &message::codec(definition, &view, "<'a>", &types);
    source += &message::encode(&view, &format!("<{name} as crate::Message>::TYPE"), "<'a>");
    source += &format!(
        "impl<'a> {view}<'a> {{
    /// Reads a message in place; see [`crate::Message::decode`].
    ///
    /// # Errors
    /// When the bytes are not such a message.
    pub fn decode(cdr: &'a [u8]) -> ::std::result::Result<Self, crate::cdr::CdrError> {{
        crate::cdr::decode(cdr)
    }}
}}

"
    );
    Ok(source)
}
