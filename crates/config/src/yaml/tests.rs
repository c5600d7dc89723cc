use super::{Value, parse};
use proptest::prelude::*;

/// The text of the error that reading `text` with `read` gives.
fn error_of<T: std::fmt::Debug>(text: &str, read: impl Fn(&super::Node) -> Result<T, crate::ConfigError>) -> String {
    parse("f.yaml", text).and_then(|root| read(&root)).unwrap_err().to_string()
}

#[test]
fn nodes_know_their_line_and_path() {
    let root = parse("f.yaml", "a:\n- b: 1\n  c:\n  - 2\n  - 'three'\n").unwrap();
    let map = root.map().unwrap();
    let inner = map.list("a").unwrap()[0].map().unwrap();
    let last = &inner.list("c").unwrap()[1];
    assert_eq!((last.origin.to_string().as_str(), last.path.as_str()), ("f.yaml:5", "a[0].c[1]"));
    assert_eq!(last.value, Value::Scalar { text: "three".to_owned(), plain: false });
}

#[test]
fn an_empty_file_is_empty() {
    for text in ["", "# nothing\n", "---\n"] {
        assert!(parse("f.yaml", text).unwrap().is_empty(), "{text:?}");
    }
}

#[test]
fn bad_structure_is_refused() {
    for (text, expected) in [
        ("a: 1\na: 2\n", "f.yaml:2: a: duplicate key; keep one"),
        ("a: &x 1\nb: *x\n", "f.yaml:1: a: is an anchor or alias; write the value out"),
        ("a: !!int 1\n", "f.yaml:1: a: has a tag other than !!str; leave it out"),
        ("a: !map {}\n", "f.yaml:1: a: has a tag; leave tags out"),
        ("? [1]\n: 2\n", "f.yaml:1: has a key that is no plain text; write key: value"),
        ("a: 1\n---\nb: 2\n", "f.yaml:3: a second document; keep one to a file"),
        (
            "a: [1\n",
            "f.yaml:2: not valid YAML at column 1: while parsing a flow sequence, expected ',' or ']'; check indentation, quotes and brackets",
        ),
    ] {
        assert_eq!(error_of(text, |_| Ok(())), expected, "{text}");
    }
    let deep = format!("{}{}", "[".repeat(100), "]".repeat(100));
    assert!(error_of(&deep, |_| Ok(())).contains("is nested too deeply"));
}

#[test]
fn wrong_types_are_named() {
    for (text, expected) in [
        ("x: yes", "f.yaml:1: x = yes: is a boolean; write a number"),
        ("x: '1'", "f.yaml:1: x = \"1\": is a text; write a number"),
        ("x: .inf", "f.yaml:1: x = .inf: is not finite; write a finite number"),
        ("x: [1]", "f.yaml:1: x: is a list; write a number"),
        ("x:", "f.yaml:1: x: has no value; write a number"),
        ("y: 1", "f.yaml:1: x: is missing; add it, or did you mean it by `y`?"),
        ("other: 1", "f.yaml:1: x: is missing; add it"),
        ("[1]", "f.yaml:1: is a list; write a map (key: value)"),
    ] {
        assert_eq!(error_of(text, |root| root.map()?.f64("x")), expected, "{text}");
    }
    assert_eq!(
        error_of("x: 3", |root| root.map()?.str("x").map(str::to_owned)),
        "f.yaml:1: x = 3: is an integer; write a text in quotes"
    );
    assert_eq!(
        error_of("x: -1", |root| root.map()?.get::<u8>("x")),
        "f.yaml:1: x = -1: is out of range; write an integer from 0 to 255"
    );
    assert_eq!(error_of("x: [1, 2]", |root| root.map()?.get::<[f64; 3]>("x")), "f.yaml:1: x: has 2 elements; write 3");
    assert_eq!(
        error_of("x: mpa", |root| root.map()?.one_of("x", &[("target", 1), ("map", 2)])),
        "f.yaml:1: x = mpa: is none of the allowed words; did you mean `map`?"
    );
}

#[test]
fn unknown_keys_are_named_with_the_nearest_known_one() {
    let text = "queues:\n- share: 1.0\n- share: 1.0\n- share: 1.0\n  tolerence: 0.1\n";
    let read = |root: &super::Node| {
        let map = root.map()?;
        for queue in map.list("queues")? {
            let queue = queue.map()?;
            queue.f64("share")?;
            queue.opt_f64("tolerance")?;
            queue.finish()?;
        }
        map.finish()
    };
    assert_eq!(error_of(text, read), "f.yaml:5: queues[2].tolerence: unknown key; did you mean `tolerance`?");
}

proptest! {
    #[test]
    fn no_text_makes_it_panic(text in "[-a-c:\\[\\]{}&*!|>'\"#,? \n\t0-9.]{0,60}") {
        let _ = parse("f.yaml", &text);
    }
}

#[test]
fn numbers_beyond_everything_are_found_wherever_they_stand() {
    let read = |text: &str| parse("field.yaml", text).unwrap().bounded();
    assert_eq!(read("a: [1.0e+6, -1.0e+6, 1000000]\nb: {c: .nan, d: \"1e308\", e: text}\n"), Ok(()));
    let error = read("a: 1\nb:\n- {c: [0.0, -1.0e+308]}\n").unwrap_err().to_string();
    let expected = "field.yaml:3: b[0].c[1] = -1.0e+308: is beyond all that robots have to do with; write metres, seconds, m/s: \
                    at most 1000000";
    assert_eq!(error, expected);
    assert!(read("a: 1000001\n").is_err());
}
