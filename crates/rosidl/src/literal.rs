//! The values of constants and defaults.

use crate::definition::{Base, Literal, Primitive, Shape};

/// Parses the value of a constant or a default of this type.
///
/// # Errors
/// What is wrong, for a person.
pub(crate) fn parse(text: &str, base: &Base, shape: Shape) -> Result<Literal, String> {
    let limit = match shape {
        Shape::Single => return parse_one(text, base),
        Shape::Array(length) | Shape::Bounded(length) => Some(length),
        Shape::Sequence => None,
    };
    let inner = text.strip_prefix('[').and_then(|rest| rest.strip_suffix(']'));
    let inner = inner.ok_or_else(|| format!("the default `{text}` of an array is not in brackets"))?.trim();
    let parts = if inner.is_empty() { Vec::new() } else { split_list(inner) };
    let exact = matches!(shape, Shape::Array(_));
    if limit.is_some_and(|limit| parts.len() > limit || (exact && parts.len() != limit)) {
        return Err(format!("the default holds {} elements, the type {}", parts.len(), limit.unwrap_or_default()));
    }
    parts.into_iter().map(|part| parse_one(part.trim(), base)).collect::<Result<_, _>>().map(Literal::List)
}

fn parse_one(text: &str, base: &Base) -> Result<Literal, String> {
    match base {
        Base::Primitive(Primitive::Bool) => match text {
            "true" | "True" | "1" => Ok(Literal::Bool(true)),
            "false" | "False" | "0" => Ok(Literal::Bool(false)),
            _ => Err(format!("`{text}` is neither true nor false")),
        },
        Base::Primitive(Primitive::Float32 | Primitive::Float64) => match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Literal::Float(value)),
            _ => Err(format!("`{text}` is not a finite number")),
        },
        Base::Primitive(primitive) => parse_integer(text, *primitive),
        Base::String { .. } | Base::WideString { .. } => Ok(Literal::Text(unquote(text))),
        Base::Nested(name) => Err(format!("a field of type {name} cannot have a value in the text")),
    }
}

fn parse_integer(text: &str, primitive: Primitive) -> Result<Literal, String> {
    let (negative, digits) = match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    };
    let lower = digits.to_ascii_lowercase();
    let magnitude = match (lower.get(..2), lower.get(2..)) {
        (Some("0x"), Some(rest)) => i128::from_str_radix(rest, 16),
        (Some("0o"), Some(rest)) => i128::from_str_radix(rest, 8),
        (Some("0b"), Some(rest)) => i128::from_str_radix(rest, 2),
        _ => lower.parse(),
    };
    let value = magnitude.map_err(|_| format!("`{text}` is not an integer"))?;
    let value = if negative { -value } else { value };
    match primitive.integer_range() {
        Some((least, greatest)) if (least..=greatest).contains(&value) => Ok(Literal::Integer(value)),
        _ => Err(format!("{text} does not fit {}", primitive.name())),
    }
}

fn unquote(text: &str) -> String {
    for quote in ['"', '\''] {
        let inner = text.strip_prefix(quote).and_then(|rest| rest.strip_suffix(quote));
        if let Some(inner) = inner {
            return inner.replace(&format!("\\{quote}"), &quote.to_string());
        }
    }
    text.to_owned()
}

/// Splits at the commas outside quotes.
fn split_list(text: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let (mut start, mut quote) = (0, None);
    for (at, character) in text.char_indices() {
        match (character, quote) {
            ('"' | '\'', None) => quote = Some(character),
            (_, Some(open)) if open == character => quote = None,
            (',', None) => {
                parts.push(&text[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&text[start..]);
    parts
}
