//! RIHS01: the SHA-256 of a type description in one exact JSON spelling (REP-2016).

use crate::definition::{Base, Definition, Field, PLACEHOLDER, Primitive, Shape};
use sha2::{Digest, Sha256};

/// `dependencies` are all that `root` contains, ordered by name.
pub(crate) fn rihs01(root: &Definition, dependencies: &[&Definition]) -> String {
    let dependencies: Vec<String> = dependencies.iter().map(|definition| individual(definition)).collect();
    // Names are identifiers, so that no character of them needs escaping.
    let json = format!(
        "{{\"type_description\": {}, \"referenced_type_descriptions\": [{}]}}",
        individual(root),
        dependencies.join(", ")
    );
    let digest = Sha256::digest(json.as_bytes());
    digest.iter().fold("RIHS01_".to_owned(), |text, byte| text + &format!("{byte:02x}"))
}

fn individual(definition: &Definition) -> String {
    let fields: Vec<String> = match &definition.fields[..] {
        [] => vec![field_json(PLACEHOLDER, type_id(Primitive::UInt8), 0, 0, "")],
        fields => fields.iter().map(field).collect(),
    };
    format!("{{\"type_name\": \"{}\", \"fields\": [{}]}}", definition.name, fields.join(", "))
}

fn field(field: &Field) -> String {
    let (id, string_capacity, nested) = match &field.base {
        Base::Primitive(primitive) => (type_id(*primitive), 0, ""),
        Base::String { bound: None } => (17, 0, ""),
        Base::WideString { bound: None } => (18, 0, ""),
        Base::String { bound: Some(bound) } => (21, *bound, ""),
        Base::WideString { bound: Some(bound) } => (22, *bound, ""),
        Base::Nested(name) => (1, 0, name.as_str()),
    };
    let (block, capacity) = match field.shape {
        Shape::Single => (0, 0),
        Shape::Array(length) => (48, length),
        Shape::Bounded(bound) => (96, bound),
        Shape::Sequence => (144, 0),
    };
    field_json(&field.name, id + block, capacity, string_capacity, nested)
}

fn field_json(name: &str, id: u8, capacity: usize, string_capacity: usize, nested: &str) -> String {
    format!(
        "{{\"name\": \"{name}\", \"type\": {{\"type_id\": {id}, \"capacity\": {capacity}, \
         \"string_capacity\": {string_capacity}, \"nested_type_name\": \"{nested}\"}}}}"
    )
}

/// The numbers of `type_description_interfaces/msg/FieldType`.
const fn type_id(primitive: Primitive) -> u8 {
    match primitive {
        Primitive::Int8 => 2,
        Primitive::UInt8 => 3,
        Primitive::Int16 => 4,
        Primitive::UInt16 => 5,
        Primitive::Int32 => 6,
        Primitive::UInt32 => 7,
        Primitive::Int64 => 8,
        Primitive::UInt64 => 9,
        Primitive::Float32 => 10,
        Primitive::Float64 => 11,
        Primitive::Bool => 15,
        Primitive::Byte => 16,
    }
}
