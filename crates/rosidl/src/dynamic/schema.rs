//! A `ros2msg` text made ready for decoding.

use crate::definition::{Base, Definition, Primitive, Shape};
use crate::ros2msg::full_name;
use crate::{Error, Library};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A type with all that it contains.
#[derive(Debug, Clone)]
pub struct Schema {
    /// Each behind those that it contains; the last is the type itself.
    pub(super) structures: Vec<Structure>,
}

#[derive(Debug, Clone)]
pub(super) struct Structure {
    pub(super) fields: Vec<Member>,
    /// The fewest bytes on the wire, at least 1.
    pub(super) smallest: usize,
}

#[derive(Debug, Clone)]
pub(super) struct Member {
    pub(super) name: Arc<str>,
    pub(super) element: Element,
    pub(super) shape: Shape,
    /// The fewest bytes of one element on the wire, at least 1.
    pub(super) smallest: usize,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Element {
    Primitive(Primitive),
    Text {
        bound: Option<usize>,
    },
    /// An index into [`Schema::structures`].
    Structure(usize),
}

impl Schema {
    /// Parses the definition of the type `name`, for example `nav_msgs/msg/Odometry`, with its dependencies: the form of
    /// `TypeInfo::definition` and of bags with the schema encoding `ros2msg`.
    ///
    /// # Errors
    /// When the text is not such a definition, a dependency is missing, or a `wstring` is in it.
    pub fn parse(name: &str, ros2msg: &str) -> Result<Self, Error> {
        let library = Library::from_ros2msg(name, ros2msg)?;
        let mut structures: Vec<Structure> = Vec::new();
        let mut indices = BTreeMap::new();
        for definition in library.closure(&full_name(name)?)? {
            structures.push(structure(definition, &structures, &indices)?);
            indices.insert(definition.name.as_str(), structures.len() - 1);
        }
        Ok(Self { structures })
    }
}

fn structure(
    definition: &Definition,
    known: &[Structure],
    indices: &BTreeMap<&str, usize>,
) -> Result<Structure, Error> {
    let mut fields = Vec::new();
    let mut smallest: usize = 0;
    for field in &definition.fields {
        let (element, element_smallest) = match &field.base {
            Base::Primitive(primitive) => (Element::Primitive(*primitive), primitive.size()),
            Base::String { bound } => (Element::Text { bound: *bound }, 4),
            Base::WideString { .. } => {
                let name = format!("{}.{}", definition.name, field.name);
                return Err(Error::Unsupported { name, what: "a wstring" });
            }
            Base::Nested(name) => {
                let missing = || Error::Missing { name: definition.name.clone(), missing: name.clone() };
                let index = *indices.get(name.as_str()).ok_or_else(missing)?;
                (Element::Structure(index), known[index].smallest)
            }
        };
        smallest = smallest.saturating_add(match field.shape {
            Shape::Single => element_smallest,
            Shape::Array(length) => element_smallest.saturating_mul(length),
            Shape::Sequence | Shape::Bounded(_) => 4,
        });
        let name = field.name.as_str().into();
        fields.push(Member { name, element, shape: field.shape, smallest: element_smallest });
    }
    Ok(Structure { fields, smallest: smallest.max(1) })
}
