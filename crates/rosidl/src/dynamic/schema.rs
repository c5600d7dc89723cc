//! A `ros2msg` text made ready for decoding.

use crate::definition::{Base, Definition, Primitive, Shape};
use crate::{Error, Library, parse_message};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The line between definitions has at least so many `=`.
const SEPARATOR: usize = 80;

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
        let name = full_name(name)?;
        let mut library = Library::default();
        for (part, text) in split(&name, ros2msg)? {
            // Some recorders repeat dependencies.
            if library.get(&part).is_none() {
                library.add_message(parse_message(&part, &text)?)?;
            }
        }
        let mut structures: Vec<Structure> = Vec::new();
        let mut indices = BTreeMap::new();
        for definition in library.closure(&name)? {
            structures.push(structure(definition, &structures, &indices)?);
            indices.insert(definition.name.as_str(), structures.len() - 1);
        }
        Ok(Self { structures })
    }
}

/// The name and text of each part.
fn split(root: &str, ros2msg: &str) -> Result<Vec<(String, String)>, Error> {
    let mut parts = vec![(root.to_owned(), String::new())];
    let mut lines = ros2msg.lines().enumerate();
    while let Some((_, line)) = lines.next() {
        if line.len() >= SEPARATOR && line.trim_end().bytes().all(|byte| byte == b'=') {
            let (index, line) = lines.next().unwrap_or_default();
            let problem = || Error::Syntax {
                name: root.to_owned(),
                line: index + 1,
                problem: format!("`MSG: package/Type` is expected behind a line of `=`, not `{line}`"),
            };
            let name = line.strip_prefix("MSG:").ok_or_else(problem)?;
            parts.push((full_name(name.trim())?, String::new()));
        } else if let Some((_, text)) = parts.last_mut() {
            text.push_str(line);
            text.push('\n');
        }
    }
    Ok(parts)
}

/// `package/msg/Name` of `package/Name` or itself.
fn full_name(name: &str) -> Result<String, Error> {
    match name.split('/').collect::<Vec<_>>()[..] {
        [package, short] => Ok(format!("{package}/msg/{short}")),
        [_, _, _] => Ok(name.to_owned()),
        _ => Err(Error::Name(name.to_owned())),
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
