//! ROS 2 interface definitions: parse `.msg` and `.srv` text, compute RIHS01 type hashes, read and write CDR, generate
//! Rust.
//!
//! The text of a definition becomes a [`Definition`] ([`parse_message`], [`parse_service`]); a [`Library`] of them
//! resolves references and knows every type's hash and its `ros2msg` text; [`generate()`] turns a library into Rust
//! source that uses [`cdr`]; [`dynamic::Schema`] decodes a type known only at run time, as tools and bags need it.

pub mod cdr;
pub mod definition;
pub mod dynamic;
mod error;
mod generate;
mod hash;
mod library;
mod literal;
mod parse;
mod primitive;
mod ros2msg;
mod service;

pub use definition::Definition;
pub use error::Error;
pub use generate::{Settings, generate};
pub use library::Library;
pub use parse::{parse_message, parse_service};
