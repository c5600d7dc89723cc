//! What a scalar means.

/// A scalar, resolved by the rules of rcl_yaml_param_parser (its `get_value`): YAML 1.1 booleans, C integers (`0x1f`,
/// `017` is octal), C real numbers and `.inf`, `.nan`; all else, and all in quotes, is a string.
#[derive(Debug, Clone, PartialEq)]
pub enum Scalar<'a> {
    /// `true`, `yes`, `on`, `y` ...
    Bool(bool),
    /// `3`, `-0x1f`
    Integer(i64),
    /// `3.0`, `1e-3`, `.inf`
    Double(f64),
    /// Anything else.
    String(&'a str),
}

impl<'a> Scalar<'a> {
    /// Resolves `text`; `plain` says that it was written without quotes.
    #[must_use]
    pub fn resolve(text: &'a str, plain: bool) -> Self {
        if !plain {
            return Self::String(text);
        }
        match text {
            "Y" | "y" | "yes" | "Yes" | "YES" | "true" | "True" | "TRUE" | "on" | "On" | "ON" => Self::Bool(true),
            "N" | "n" | "no" | "No" | "NO" | "false" | "False" | "FALSE" | "off" | "Off" | "OFF" => Self::Bool(false),
            _ => match (integer(text), double(text)) {
                (Some(value), _) => Self::Integer(value),
                (None, Some(value)) => Self::Double(value),
                (None, None) => Self::String(text),
            },
        }
    }
}

/// C's `strtoll(text, _, 0)` on a whole text.
fn integer(text: &str) -> Option<i64> {
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    let (digits, radix) = match digits.as_bytes() {
        [b'0', b'x' | b'X', ..] => (&digits[2..], 16),
        [b'0', _, ..] => (&digits[1..], 8),
        _ => (digits, 10),
    };
    // from_str_radix would accept a second sign.
    if !digits.starts_with(|first: char| first.is_ascii_hexdigit()) {
        return None;
    }
    let sign = if text.starts_with('-') { "-" } else { "" };
    i64::from_str_radix(&format!("{sign}{digits}"), radix).ok()
}

/// C's `strtod` on a whole text (without hexadecimal fractions), and YAML's `.inf` and `.nan`. A number too large for
/// a double is none.
fn double(text: &str) -> Option<f64> {
    match text {
        ".nan" | ".NaN" | ".NAN" => return Some(f64::NAN),
        ".inf" | ".Inf" | ".INF" | "+.inf" | "+.Inf" | "+.INF" => return Some(f64::INFINITY),
        "-.inf" | "-.Inf" | "-.INF" => return Some(f64::NEG_INFINITY),
        _ => {}
    }
    let value: f64 = text.parse().ok()?;
    let overflowed = value.is_infinite() && text.contains(|letter: char| letter.is_ascii_digit());
    (!overflowed).then_some(value)
}

#[cfg(test)]
mod tests {
    use super::Scalar::{self, Bool, Double, Integer, String};

    #[test]
    fn resolves_as_rcl_does() {
        for (text, expected) in [
            ("yes", Bool(true)),
            ("Off", Bool(false)),
            ("n", Bool(false)),
            ("tRUE", String("tRUE")),
            ("3", Integer(3)),
            ("-3", Integer(-3)),
            ("+0x1F", Integer(31)),
            ("017", Integer(15)),
            ("0", Integer(0)),
            ("-9223372036854775808", Integer(i64::MIN)),
            ("9223372036854775808", Double(9_223_372_036_854_775_808.0)),
            ("08", Double(8.0)),
            ("1.0", Double(1.0)),
            ("1e3", Double(1000.0)),
            (".5", Double(0.5)),
            ("5.", Double(5.0)),
            (".inf", Double(f64::INFINITY)),
            ("-.INF", Double(f64::NEG_INFINITY)),
            ("1e400", String("1e400")),
            ("--3", String("--3")),
            ("0x", String("0x")),
            ("1_000", String("1_000")),
            ("~", String("~")),
            ("", String("")),
        ] {
            assert_eq!(Scalar::resolve(text, true), expected, "{text}");
        }
        assert_eq!(Scalar::resolve("3", false), String("3"));
    }
}
