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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_every_type() {
        let check = |text: &str, primitive, expected: Result<Literal, &str>| {
            let found = parse(text, &Base::Primitive(primitive), Shape::Single);
            assert_eq!(found, expected.map_err(str::to_owned), "{text}");
        };
        check("-128", Primitive::Int8, Ok(Literal::Integer(-128)));
        check("0x1F", Primitive::UInt8, Ok(Literal::Integer(31)));
        check("-0b101", Primitive::Int16, Ok(Literal::Integer(-5)));
        check("18446744073709551615", Primitive::UInt64, Ok(Literal::Integer(i128::from(u64::MAX))));
        check("256", Primitive::Byte, Err("256 does not fit byte"));
        check("-1", Primitive::UInt32, Err("-1 does not fit uint32"));
        check("1.5", Primitive::Int32, Err("`1.5` is not an integer"));
        check("", Primitive::Int32, Err("`` is not an integer"));
        check("1e-3", Primitive::Float64, Ok(Literal::Float(0.001)));
        check("nan", Primitive::Float32, Err("`nan` is not a finite number"));
        check("True", Primitive::Bool, Ok(Literal::Bool(true)));
        check("yes", Primitive::Bool, Err("`yes` is neither true nor false"));
    }

    #[test]
    fn strings_lose_their_quotes() {
        let check = |text: &str, expected: &str| {
            let found = parse(text, &Base::String { bound: None }, Shape::Single);
            assert_eq!(found, Ok(Literal::Text(expected.to_owned())), "{text}");
        };
        check("\"a \\\" b\"", "a \" b");
        check("'it'", "it");
        check("bare words", "bare words");
        check("\"", "\"");
    }

    #[test]
    fn arrays_hold_as_many_as_their_type() {
        let numbers = Base::Primitive(Primitive::UInt8);
        let list = |values: &[i128]| Ok(Literal::List(values.iter().copied().map(Literal::Integer).collect()));
        assert_eq!(parse("[1, 2]", &numbers, Shape::Array(2)), list(&[1, 2]));
        assert_eq!(parse("[]", &numbers, Shape::Sequence), list(&[]));
        assert_eq!(parse("[7]", &numbers, Shape::Bounded(2)), list(&[7]));
        for (text, shape) in [("[1]", Shape::Array(2)), ("[1, 2, 3]", Shape::Bounded(2)), ("1, 2", Shape::Sequence)] {
            assert!(parse(text, &numbers, shape).is_err(), "{text}");
        }
        let texts = parse("['a, b', c]", &Base::String { bound: None }, Shape::Sequence);
        assert_eq!(texts, Ok(Literal::List(vec![Literal::Text("a, b".to_owned()), Literal::Text("c".to_owned())])));
    }
}
