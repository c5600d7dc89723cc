//! The `param` entries of a node.

use super::Text;
use super::attributes::{opt_text, plain_text, text};
use crate::literal::Literal;
use trench_config::ConfigError;
use trench_config::yaml::{Map, Node, Value};

/// One entry of `param`.
#[derive(Debug)]
pub(crate) enum Parameter<'a> {
    /// `from`: a parameter file.
    File(Text<'a>),
    /// `name` with a value or with more parameters below it.
    Inline(ParameterTree<'a>),
}

/// A parameter or a prefix with parameters below it.
#[derive(Debug)]
pub(crate) struct ParameterTree<'a> {
    pub(crate) name: Text<'a>,
    pub(crate) value: ParameterValue<'a>,
}

/// What a `param` entry gives.
#[derive(Debug)]
pub(crate) enum ParameterValue<'a> {
    /// A value, of a type that may be asked for.
    Scalar(Item<'a>, Option<Type>),
    /// A list of values of one type.
    List(&'a Node, Vec<Item<'a>>),
    /// Parameters below a prefix.
    Group(Vec<ParameterTree<'a>>),
}

/// A value, or a text with substitutions that becomes one.
#[derive(Debug)]
pub(crate) enum Item<'a> {
    Literal(Literal),
    Text(Text<'a>),
}

/// What `type` asks a substituted value to become.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Type {
    Bool,
    Int,
    Float,
    Text,
}

/// Reads one entry of `param`.
pub(super) fn parameter<'a>(map: &Map<'a>) -> Result<Parameter<'a>, ConfigError> {
    match opt_text(map, "from")? {
        Some(_) if map.opt_node("name").is_some() => Err(map.error("from", "stands beside `name`", "use one of them")),
        Some(file) => Ok(Parameter::File(file)),
        None => tree(map).map(Parameter::Inline),
    }
}

fn tree<'a>(map: &Map<'a>) -> Result<ParameterTree<'a>, ConfigError> {
    let name = text(map, "name")?;
    let kind = map.opt_node("type").map(kind).transpose()?;
    let value = match (map.opt_node("value"), map.opt_node("param")) {
        (Some(node), None) => value(node, kind)?,
        (None, Some(node)) if kind.is_none() => {
            let read = |node: &'a Node| {
                let entry = node.map()?;
                let tree = tree(&entry)?;
                entry.finish()?;
                Ok(tree)
            };
            ParameterValue::Group(node.list()?.iter().map(read).collect::<Result<_, ConfigError>>()?)
        }
        (None, None) => return Err(map.error("value", "is missing", "add it, or `param` with parameters below it")),
        (Some(_), Some(_)) => return Err(map.error("param", "stands beside `value`", "use one of them")),
        (None, Some(_)) => return Err(map.error("type", "stands beside `param`", "give the type with the value")),
    };
    Ok(ParameterTree { name, value })
}

fn kind(node: &Node) -> Result<Type, ConfigError> {
    match plain_text(node)?.as_str() {
        "bool" => Ok(Type::Bool),
        "int" => Ok(Type::Int),
        "float" => Ok(Type::Float),
        "str" => Ok(Type::Text),
        _ => Err(node.error("is no type known here", "write bool, int, float or str")),
    }
}

fn value(node: &Node, kind: Option<Type>) -> Result<ParameterValue<'_>, ConfigError> {
    let Value::List(nodes) = &node.value else {
        let item = item(node)?;
        let fits = match (&item, kind) {
            (Item::Text(_), _) | (_, None) => true,
            (Item::Literal(literal), Some(kind)) => literal_type(literal) == Some(kind),
        };
        if !fits {
            return Err(node.error("is not of the type given", "change `type` or the value"));
        }
        return Ok(ParameterValue::Scalar(item, kind));
    };
    let items = nodes.iter().map(item).collect::<Result<Vec<_>, _>>()?;
    Ok(ParameterValue::List(node, items))
}

fn item(node: &Node) -> Result<Item<'_>, ConfigError> {
    match Literal::of(node) {
        Some(Literal::Text(_)) => {
            let text = Text::parse(node)?;
            Ok(match text.template.literal() {
                Some(literal) => Item::Literal(Literal::Text(literal.to_owned())),
                None => Item::Text(text),
            })
        }
        Some(Literal::Null) => Err(node.error("has no value", "write a value")),
        Some(literal) => Ok(Item::Literal(literal)),
        None => Err(node.error("is not a single value", "write a value or a list of values")),
    }
}

/// The type of a literal.
pub(crate) fn literal_type(literal: &Literal) -> Option<Type> {
    match literal {
        Literal::Bool(_) => Some(Type::Bool),
        Literal::Int(_) => Some(Type::Int),
        Literal::Float(_) => Some(Type::Float),
        Literal::Text(_) => Some(Type::Text),
        Literal::Null => None,
    }
}
