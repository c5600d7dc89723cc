//! What a scalar of a launch file means: the real `ros2 launch` reads them with PyYAML, which follows YAML 1.1 and
//! differs from ROS 2's parameter files (`y` is a text, `1e3` is a text, `1_000` is an integer).

use trench_config::yaml::{Node, Value};

/// A scalar as PyYAML types it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Literal {
    /// `~`, `null` or nothing.
    Null,
    /// `true`, `yes`, `on` ...
    Bool(bool),
    /// `3`, `0x1f`, `017`, `0b11`, `1_000`
    Int(i64),
    /// `3.0`, `1.0e+3`, `.inf`; never without a point.
    Float(f64),
    /// Anything else, and all in quotes.
    Text(String),
}

impl Literal {
    /// The scalar at `node`; `None` for lists and maps.
    pub(crate) fn of(node: &Node) -> Option<Self> {
        match &node.value {
            Value::Scalar { text, plain: false } => Some(Self::Text(text.clone())),
            Value::Scalar { text, plain: true } => Some(Self::resolve(text)),
            Value::List(_) | Value::Map(_) => None,
        }
    }

    /// Resolves an unquoted scalar.
    pub(crate) fn resolve(text: &str) -> Self {
        match text {
            "" | "~" | "null" | "Null" | "NULL" => Self::Null,
            "yes" | "Yes" | "YES" | "true" | "True" | "TRUE" | "on" | "On" | "ON" => Self::Bool(true),
            "no" | "No" | "NO" | "false" | "False" | "FALSE" | "off" | "Off" | "OFF" => Self::Bool(false),
            _ => integer(text)
                .map(Self::Int)
                .or_else(|| real(text).map(Self::Float))
                .unwrap_or_else(|| Self::Text(text.to_owned())),
        }
    }

    /// What it is, for messages.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Null => "has no value",
            Self::Bool(_) => "is a boolean",
            Self::Int(_) => "is an integer",
            Self::Float(_) => "is a real number",
            Self::Text(_) => "is a text",
        }
    }

    /// Whether both are of one type.
    pub(crate) fn same_type(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }
}

fn integer(text: &str) -> Option<i64> {
    let (sign, digits) = match text.strip_prefix('-') {
        Some(digits) => ("-", digits),
        None => ("", text.strip_prefix('+').unwrap_or(text)),
    };
    let (digits, radix) = match digits.as_bytes() {
        [b'0', b'x', ..] => (&digits[2..], 16),
        [b'0', b'b', ..] => (&digits[2..], 2),
        [b'0', _, ..] => (&digits[1..], 8),
        [b'0'..=b'9', ..] => (digits, 10),
        _ => return None,
    };
    let digits = digits.replace('_', "");
    if !digits.starts_with(|first: char| first.is_ascii_hexdigit()) {
        return None;
    }
    i64::from_str_radix(&format!("{sign}{digits}"), radix).ok()
}

fn real(text: &str) -> Option<f64> {
    let (sign, magnitude) = match text.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, text.strip_prefix('+').unwrap_or(text)),
    };
    match magnitude {
        ".inf" | ".Inf" | ".INF" => return Some(sign * f64::INFINITY),
        ".nan" | ".NaN" | ".NAN" if magnitude == text => return Some(f64::NAN),
        _ => {}
    }
    let (mantissa, exponent) = match magnitude.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, Some(exponent)),
        None => (magnitude, None),
    };
    let (whole, fraction) = mantissa.split_once('.')?;
    let digits_only = |part: &str| part.chars().all(|letter| letter.is_ascii_digit() || letter == '_');
    let first = if whole.is_empty() { fraction } else { whole };
    let exponent_is_signed = exponent.is_none_or(|exponent| {
        exponent
            .strip_prefix(['+', '-'])
            .is_some_and(|digits| !digits.is_empty() && digits.bytes().all(|digit| digit.is_ascii_digit()))
    });
    let valid = digits_only(whole)
        && digits_only(fraction)
        && first.starts_with(|letter: char| letter.is_ascii_digit())
        && (!whole.is_empty() || magnitude == text)
        && exponent_is_signed;
    if !valid {
        return None;
    }
    magnitude.replace('_', "").parse::<f64>().ok().map(|value| sign * value)
}

#[cfg(test)]
mod tests {
    use super::Literal::{self, Bool, Float, Int, Null};

    #[test]
    fn resolves_as_pyyaml_does() {
        let text = |text: &str| Literal::Text(text.to_owned());
        for (input, expected) in [
            ("", Null),
            ("~", Null),
            ("on", Bool(true)),
            ("No", Bool(false)),
            ("y", text("y")),
            ("3", Int(3)),
            ("-0x1f", Int(-31)),
            ("017", Int(15)),
            ("08", text("08")),
            ("0b11", Int(3)),
            ("1_000", Int(1000)),
            ("1.0", Float(1.0)),
            ("-1.", Float(-1.0)),
            (".5", Float(0.5)),
            ("-.5", text("-.5")),
            ("1e3", text("1e3")),
            ("1.0e3", text("1.0e3")),
            ("1.0e+3", Float(1000.0)),
            ("-.inf", Float(f64::NEG_INFINITY)),
            ("1.2.3", text("1.2.3")),
            ("robot1", text("robot1")),
            ("-", text("-")),
        ] {
            assert_eq!(Literal::resolve(input), expected, "{input}");
        }
    }
}
