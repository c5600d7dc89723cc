//! Writing a parameter file as PyYAML's `yaml.dump` does, so that nodes see what the real `ros2 launch` gives them.

use crate::literal::Literal;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// A value that a launch file gives to a parameter.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ParameterData {
    /// One value.
    Scalar(Literal),
    /// A list of values of one type.
    List(Vec<Literal>),
    /// Parameters under a common prefix.
    Group(BTreeMap<String, ParameterData>),
}

/// The text of a parameter file that gives `data` (a group, its maps flattened to dotted names) to `node`.
pub(crate) fn parameter_file(node: &str, data: &BTreeMap<String, ParameterData>) -> String {
    let mut flat = BTreeMap::new();
    flatten("", data, &mut flat);
    let mut text = format!("{}:\n  ros__parameters:\n", scalar(&Literal::Text(node.to_owned())));
    for (name, value) in flat {
        let name = scalar(&Literal::Text(name));
        // Writing to a String cannot fail.
        let _ = match value {
            ParameterData::Scalar(value) => writeln!(text, "    {name}: {}", scalar(value)),
            ParameterData::List(values) if values.is_empty() => writeln!(text, "    {name}: []"),
            ParameterData::List(values) => {
                let items: String = values.iter().map(|value| format!("\n    - {}", scalar(value))).collect();
                writeln!(text, "    {name}:{items}")
            }
            ParameterData::Group(_) => Ok(()),
        };
    }
    text
}

fn flatten<'a>(
    prefix: &str,
    data: &'a BTreeMap<String, ParameterData>,
    flat: &mut BTreeMap<String, &'a ParameterData>,
) {
    for (name, value) in data {
        let name = format!("{prefix}{name}");
        match value {
            ParameterData::Group(inner) => flatten(&format!("{name}."), inner, flat),
            ParameterData::Scalar(_) | ParameterData::List(_) => {
                flat.insert(name, value);
            }
        }
    }
}

fn scalar(value: &Literal) -> String {
    match value {
        Literal::Null => "null".to_owned(),
        Literal::Bool(value) => value.to_string(),
        Literal::Int(value) => value.to_string(),
        Literal::Float(value) => float(*value),
        Literal::Text(text) => string(text),
    }
}

/// Python's `repr`, with the point that makes PyYAML read it back as a float.
fn float(value: f64) -> String {
    if value.is_nan() {
        return ".nan".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 { ".inf" } else { "-.inf" }.to_owned();
    }
    let text = format!("{value:?}");
    let Some((mantissa, exponent)) = text.split_once('e') else { return text };
    let point = if mantissa.contains('.') { "" } else { ".0" };
    let (sign, digits) = match exponent.strip_prefix('-') {
        Some(digits) => ('-', digits),
        None => ('+', exponent),
    };
    format!("{mantissa}{point}e{sign}{digits:0>2}")
}

fn string(text: &str) -> String {
    if text.chars().any(|letter| !(' '..='~').contains(&letter)) {
        return double_quoted(text);
    }
    let is_text = matches!(Literal::resolve(text), Literal::Text(_));
    let first_is_free =
        !text.starts_with(['#', ',', '[', ']', '{', '}', '&', '*', '!', '|', '>', '\'', '"', '%', '@', '`', ' ']);
    let no_indicator = !["-", "?", ":", "="].contains(&text)
        && !text.starts_with("- ")
        && !text.starts_with("? ")
        && !text.starts_with("---")
        && !text.starts_with("...")
        && !text.starts_with(':')
        && !text.contains(": ")
        && !text.contains(" #")
        && !text.ends_with([':', ' ']);
    if is_text && first_is_free && no_indicator { text.to_owned() } else { format!("'{}'", text.replace('\'', "''")) }
}

fn double_quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            '\n' => quoted.push_str("\\n"),
            '\t' => quoted.push_str("\\t"),
            ' '..='~' => quoted.push(letter),
            _ => {
                let code = u32::from(letter);
                // Writing to a String cannot fail.
                let _ = match code {
                    0..0x100 => write!(quoted, "\\x{code:02X}"),
                    0x100..0x1_0000 => write!(quoted, "\\u{code:04X}"),
                    _ => write!(quoted, "\\U{code:08X}"),
                };
            }
        }
    }
    quoted.push('"');
    quoted
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trench_config::yaml;

    #[test]
    fn writes_floats_as_python_does() {
        for (value, expected) in
            [(0.1, "0.1"), (1.0, "1.0"), (1e-5, "1.0e-05"), (1.5e20, "1.5e+20"), (1e16, "1.0e+16"), (-0.25, "-0.25")]
        {
            assert_eq!(float(value), expected);
        }
    }

    #[test]
    fn flattens_groups_into_dotted_names() {
        let gains = BTreeMap::from([("k1".to_owned(), ParameterData::Scalar(Literal::Float(0.1)))]);
        let data = BTreeMap::from([
            ("rank".to_owned(), ParameterData::Scalar(Literal::Int(3))),
            ("gains".to_owned(), ParameterData::Group(gains)),
        ]);
        assert_eq!(parameter_file("/**", &data), "/**:\n  ros__parameters:\n    gains.k1: 0.1\n    rank: 3\n");
    }

    proptest! {
        #[test]
        fn any_text_reads_back_as_the_same_text(text in "\\PC{0,12}|[ -~\n\t]{0,8}|[-:#'\" a1.]{0,5}") {
            let written = format!("key: {}\n", string(&text));
            let root = yaml::parse("written", &written).unwrap();
            let map = root.map().unwrap();
            prop_assert_eq!(Literal::of(map.node("key").unwrap()), Some(Literal::Text(text)), "{}", written);
        }
    }
}
