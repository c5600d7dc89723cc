//! The text of `.msg` and `.srv` files.

use crate::definition::{Base, Constant, Definition, Field, Primitive, Service, Shape};
use crate::{Error, literal};
use std::collections::BTreeSet;

/// Parses the text of a `.msg` file. `name` is `package/msg/Name`.
///
/// # Errors
/// With the line that is not understood.
pub fn parse_message(name: &str, text: &str) -> Result<Definition, Error> {
    let package = match name.split('/').collect::<Vec<_>>()[..] {
        [package, "msg" | "srv", short] if is_identifier(package) && is_identifier(short) => package,
        _ => return Err(Error::Name(name.to_owned())),
    };
    let mut definition = Definition {
        name: name.to_owned(),
        comment: Vec::new(),
        constants: Vec::new(),
        fields: Vec::new(),
        text: text.to_owned(),
    };
    // The first block of comments describes the type, every later one what follows it.
    let mut pending = Vec::new();
    let mut at_head = true;
    let mut names = BTreeSet::new();
    for (index, line) in text.lines().enumerate() {
        let (code, comment) = split_comment(line);
        if code.is_empty() {
            match comment {
                Some(comment) if at_head => definition.comment.push(comment),
                Some(comment) => pending.push(comment),
                None => {
                    at_head &= definition.comment.is_empty();
                    pending.clear();
                }
            }
            continue;
        }
        at_head = false;
        pending.extend(comment);
        let comment = std::mem::take(&mut pending);
        let syntax = |problem| Error::Syntax { name: name.to_owned(), line: index + 1, problem };
        parse_line(code, package, comment, &mut names, &mut definition).map_err(syntax)?;
    }
    Ok(definition)
}

/// Parses the text of a `.srv` file. `name` is `package/srv/Name`.
///
/// # Errors
/// With the line that is not understood, or when there is not one line `---`.
pub fn parse_service(name: &str, text: &str) -> Result<Service, Error> {
    let separators = text.lines().filter(|line| line.trim() == "---").count();
    let lines: Vec<&str> = text.lines().collect();
    let halves: Vec<String> = lines.split(|line| line.trim() == "---").map(|half| half.join("\n")).collect();
    let [request, response] = &halves[..] else {
        return Err(Error::Separator(name.to_owned(), separators));
    };
    let mut request = parse_message(&format!("{name}_Request"), request)?;
    let response = parse_message(&format!("{name}_Response"), response)?;
    Ok(Service { name: name.to_owned(), comment: std::mem::take(&mut request.comment), request, response })
}

/// A `#` starts a comment wherever it stands, as in ROS 2's own parser.
fn split_comment(line: &str) -> (&str, Option<String>) {
    match line.split_once('#') {
        Some((code, comment)) => (code.trim(), Some(comment.trim_start_matches('#').trim().to_owned())),
        None => (line.trim(), None),
    }
}

fn parse_line(
    code: &str,
    package: &str,
    comment: Vec<String>,
    names: &mut BTreeSet<String>,
    into: &mut Definition,
) -> Result<(), String> {
    let (type_text, rest) = code.split_once(char::is_whitespace).ok_or(format!("`{code}` has a type but no name"))?;
    let rest = rest.trim();
    let (base, shape) = parse_type(type_text, package)?;
    let name_end = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(rest.len());
    let (name, tail) = rest.split_at(name_end);
    if !is_identifier(name) {
        return Err(format!("`{rest}` does not begin with a name"));
    }
    let name = name.to_owned();
    if !names.insert(name.clone()) {
        return Err(format!("the name {name} is used twice"));
    }
    if let Some(value) = tail.trim_start().strip_prefix('=') {
        if shape != Shape::Single {
            return Err(format!("the constant {name} is an array"));
        }
        let value = literal::parse(value.trim(), &base, shape)?;
        into.constants.push(Constant { name, base, value, comment });
        return Ok(());
    }
    if !(tail.is_empty() || tail.starts_with(char::is_whitespace)) {
        return Err(format!("`{tail}` follows the name {name}"));
    }
    let default = Some(tail.trim()).filter(|text| !text.is_empty());
    let default = default.map(|text| literal::parse(text, &base, shape)).transpose()?;
    into.fields.push(Field { name, base, shape, default, comment });
    Ok(())
}

fn parse_type(text: &str, package: &str) -> Result<(Base, Shape), String> {
    let (element, shape) = match text.strip_suffix(']').and_then(|rest| rest.rsplit_once('[')) {
        None => (text, Shape::Single),
        Some((element, "")) => (element, Shape::Sequence),
        Some((element, inside)) => match inside.strip_prefix("<=") {
            Some(bound) => (element, Shape::Bounded(parse_size(bound)?)),
            None => (element, Shape::Array(parse_size(inside)?)),
        },
    };
    Ok((parse_base(element, package)?, shape))
}

fn parse_base(text: &str, package: &str) -> Result<Base, String> {
    if let Some(primitive) = Primitive::from_name(text) {
        return Ok(Base::Primitive(primitive));
    }
    let (kind, bound) = match text.split_once("<=") {
        Some((kind, bound)) => (kind, Some(parse_size(bound)?)),
        None => (text, None),
    };
    match (kind, bound) {
        ("string", bound) => return Ok(Base::String { bound }),
        ("wstring", bound) => return Ok(Base::WideString { bound }),
        (_, Some(_)) => return Err(format!("`{text}`: only strings have a bound")),
        (_, None) => {}
    }
    let (package, name) = match text.split('/').collect::<Vec<_>>()[..] {
        [name] => (package, name),
        [package, name] | [package, "msg", name] => (package, name),
        _ => return Err(format!("`{text}` is not a type")),
    };
    if !(is_identifier(package) && is_identifier(name)) {
        return Err(format!("`{text}` is not a type"));
    }
    Ok(Base::Nested(format!("{package}/msg/{name}")))
}

fn parse_size(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|size| *size > 0).ok_or_else(|| format!("`{text}` is not a size of 1 or more"))
}

fn is_identifier(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic()) && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::definition::Literal;
    use proptest::prelude::*;

    fn field(line: &str) -> Result<Field, String> {
        let definition = parse_message("my_msgs/msg/Mine", line).map_err(|error| error.to_string())?;
        definition.fields.into_iter().next().ok_or_else(|| "no field".to_owned())
    }

    #[test]
    fn types_and_shapes() {
        let check = |line: &str, base: Base, shape: Shape| {
            let field = field(line).expect(line);
            assert_eq!((field.base, field.shape), (base, shape), "{line}");
        };
        let nested = |name: &str| Base::Nested(name.to_owned());
        check("float64 x", Base::Primitive(Primitive::Float64), Shape::Single);
        check("char[16] gid", Base::Primitive(Primitive::UInt8), Shape::Array(16));
        check("byte[] b", Base::Primitive(Primitive::Byte), Shape::Sequence);
        check("string<=10[<=5] names", Base::String { bound: Some(10) }, Shape::Bounded(5));
        check("wstring\tw", Base::WideString { bound: None }, Shape::Single);
        check("Other[] others", nested("my_msgs/msg/Other"), Shape::Sequence);
        check("std_msgs/Header header", nested("std_msgs/msg/Header"), Shape::Single);
        check("std_msgs/msg/Header header", nested("std_msgs/msg/Header"), Shape::Single);
    }

    #[test]
    fn comments_go_to_what_they_describe() {
        let text = "# The type,\n# in two lines.\n\n# lost\n\n# Above.\nuint8 a=1  # Behind.\nuint8 b\n";
        let definition = parse_message("my_msgs/msg/Mine", text).expect("valid");
        assert_eq!(definition.comment, ["The type,", "in two lines."]);
        assert_eq!(definition.constants[0].comment, ["Above.", "Behind."]);
        assert!(definition.fields[0].comment.is_empty());
    }

    #[test]
    fn constants_and_defaults() {
        let definition = parse_message("my_msgs/msg/Mine", "string A = it's = x\nint8 b -3\nstring c 'a=b'\n");
        let definition = definition.expect("valid");
        assert_eq!(definition.constants[0].value, Literal::Text("it's = x".to_owned()));
        assert_eq!(definition.fields[0].default, Some(Literal::Integer(-3)));
        assert_eq!(definition.fields[1].default, Some(Literal::Text("a=b".to_owned())));
    }

    #[test]
    fn services_have_two_halves() {
        let service = parse_service("my_msgs/srv/Ask", "# Asks.\nuint8 a\n---\nuint8 b\n").expect("valid");
        assert_eq!(service.comment, ["Asks."]);
        assert_eq!(service.request.name, "my_msgs/srv/Ask_Request");
        assert_eq!(service.response.fields[0].name, "b");
        for (text, separators) in [("uint8 a\n", 0), ("---\n---\n", 2)] {
            let expected = Error::Separator("my_msgs/srv/Ask".to_owned(), separators);
            assert_eq!(parse_service("my_msgs/srv/Ask", text), Err(expected));
        }
    }

    #[test]
    fn errors_name_the_line() {
        let check = |text: &str, expected: &str| {
            let error = parse_message("my_msgs/msg/Mine", text).expect_err(text);
            assert_eq!(error.to_string(), format!("my_msgs/msg/Mine, {expected}"));
        };
        check("\n\nuint8", "line 3: `uint8` has a type but no name");
        check("uint8 a\nint8 a", "line 2: the name a is used twice");
        check("uint8[0] a", "line 1: `0` is not a size of 1 or more");
        check("uint8<=4 a", "line 1: `uint8<=4`: only strings have a bound");
        check("uint8 a 300", "line 1: 300 does not fit uint8");
        check("uint8[2] A=1", "line 1: the constant A is an array");
        check("Other a 3", "line 1: a field of type my_msgs/msg/Other cannot have a value in the text");
        check("a/b/c/D d", "line 1: `a/b/c/D` is not a type");
        check("uint8 9", "line 1: `9` does not begin with a name");
        assert_eq!(parse_message("Mine", ""), Err(Error::Name("Mine".to_owned())));
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "([a-z0-9_/<=\\[\\] #'\"-]{0,30}\n){0,6}") {
            // What is understood says at least which type it is.
            if let Ok(definition) = parse_message("my_msgs/msg/Mine", &text) {
                prop_assert_eq!(definition.package(), "my_msgs");
            }
        }
    }
}
