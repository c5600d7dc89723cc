//! Decoding types that are known only at run time: those of bags, and any type for tools that take a name.
//!
//! ```
//! let definition = "Point at\nstring[] tags\n".to_owned() + &"=".repeat(80) + "\nMSG: my_msgs/Point\nfloat64 x\n";
//! let schema = trench_rosidl::dynamic::Schema::parse("my_msgs/msg/Tagged", &definition)?;
//! let cdr = [0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f, 1, 0, 0, 0, 2, 0, 0, 0, b'a', 0];
//! let value = schema.decode(&cdr)?;
//! assert_eq!(value.get("at.x").and_then(|x| x.as_f64()), Some(1.0));
//! assert_eq!(value.to_string(), "{at: {x: 1}, tags: [\"a\"]}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod decode;
mod schema;
mod value;

pub use decode::DecodeError;
pub use schema::Schema;
pub use value::Value;
