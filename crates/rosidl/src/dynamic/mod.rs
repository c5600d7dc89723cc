//! Decoding types that are known only at run time: those of bags, and any type for tools that take a name.
//!
//! ```
//! let definition = "Point at\nstring[] tags\n".to_owned() + &"=".repeat(80) + "\nMSG: my_msgs/Point\nfloat64 x\n";
//! let schema = trench_rosidl::dynamic::Schema::parse("my_msgs/msg/Tagged", &definition)?;
//! let cdr = [0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f, 1, 0, 0, 0, 2, 0, 0, 0, b'a', 0];
//! let value = schema.decode(&cdr)?;
//! assert_eq!(value.get("at.x").and_then(|x| x.as_f64()), Some(1.0));
//! assert_eq!(value.to_string(), "{at: {x: 1.0}, tags: [\"a\"]}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod decode;
mod schema;
mod value;

pub use decode::DecodeError;
pub use schema::Schema;
pub use value::Value;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;
    use crate::cdr::CdrError;

    fn schema(root: &str, parts: &[(&str, &str)]) -> Result<Schema, Error> {
        let line = "=".repeat(80);
        let parts = parts.iter().map(|(name, text)| format!("{line}\nMSG: {name}\n{text}\n"));
        Schema::parse("p/msg/Root", &(format!("{root}\n") + &parts.collect::<String>()))
    }

    /// Header and body.
    fn cdr(body: &[u8]) -> Vec<u8> {
        [&[0, 1, 0, 0], body].concat()
    }

    #[test]
    fn paths_lead_to_values() {
        let schema = schema("uint8 a\nInner[] list\nint16[2] pair\nbyte[] raw", &[("p/Inner", "float32 x\nstring s")]);
        let mut body = vec![9, 0, 0, 0, 1, 0, 0, 0];
        body.extend(0.1_f32.to_le_bytes());
        body.extend([3, 0, 0, 0, b'h', b'i', 0, 0, 0xff, 0xff, 7, 0, 2, 0, 0, 0, 5, 6]);
        let value = schema.expect("valid").decode(&cdr(&body)).expect("valid");
        assert_eq!(value.get("a").and_then(Value::as_f64), Some(9.0));
        assert_eq!(value.get("list[0].s").and_then(Value::as_str), Some("hi"));
        assert_eq!(value.get("pair[0]"), Some(&Value::Integer(-1)));
        for absent in ["b", "a.b", "a[0]", "list[1]", "list[x]", "list[0", "list[0].x.y", "raw[0]"] {
            assert_eq!(value.get(absent), None, "{absent}");
        }
        let leaves: Vec<String> = value.leaves().iter().map(|(path, leaf)| format!("{path} {leaf}")).collect();
        let expected = ["a 9", "list[0].x 0.1", "list[0].s \"hi\"", "pair[0] -1", "pair[1] 7", "raw <2 bytes>"];
        assert_eq!(leaves, expected);
        assert_eq!(value.get(""), Some(&value));
    }

    #[test]
    fn errors_name_the_path() {
        let schema = schema("Inner[] list", &[("p/Inner", "bool[2] flags")]).expect("valid");
        let error = schema.decode(&cdr(&[2, 0, 0, 0, 0, 1, 1, 2])).expect_err("2 is no boolean");
        assert_eq!(error.to_string(), "list[1].flags[1]: bool is a boolean, but neither 0 nor 1");
        let error = schema.decode(&cdr(&[2, 0, 0, 0, 0, 1, 1])).expect_err("too short");
        assert_eq!(error.to_string(), "list: the message ends at byte 11, 1 more are needed for a sequence");
        let error = schema.decode(&[0, 7, 0, 0]).expect_err("a parameter list");
        assert_eq!(error.source, CdrError::Encapsulation(7));
    }

    #[test]
    fn bounds_are_kept() {
        let schema = schema("string<=2 text\nuint8[<=1] few", &[]).expect("valid");
        assert!(schema.decode(&cdr(&[3, 0, 0, 0, b'a', b'b', 0, 0, 1, 0, 0, 0, 4])).is_ok());
        let long = schema.decode(&cdr(&[4, 0, 0, 0, b'a', b'b', b'c', 0, 0, 0, 0, 0])).expect_err("long");
        assert_eq!(long.to_string(), "text: string holds 3 elements, its bound is 2");
        let many = schema.decode(&cdr(&[1, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 4, 4])).expect_err("many");
        assert_eq!(many.path, "few");
    }

    /// 2^30 values of 8 bytes each, thirty levels deep: neither parsing nor decoding may walk all of them.
    #[test]
    fn a_definition_that_doubles_at_every_level_costs_nothing() {
        let parts: Vec<(String, String)> = (0..29)
            .map(|level| (format!("p/N{level}"), format!("N{0} a\nN{0}[65536] b", level + 1)))
            .chain([("p/N29".to_owned(), "float64 x".to_owned())])
            .collect();
        let parts: Vec<(&str, &str)> = parts.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
        let schema = schema("N0 root", &parts).expect("valid");
        let error = schema.decode(&cdr(&[0; 1000])).expect_err("too short");
        assert!(matches!(error.source, CdrError::Short { .. }));
    }

    #[test]
    fn wide_strings_are_refused() {
        let error = schema("wstring w", &[]).expect_err("not supported");
        assert_eq!(error, Error::Unsupported { name: "p/msg/Root.w".to_owned(), what: "a wstring" });
    }
}
