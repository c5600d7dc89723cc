//! The messages of Trench and the standard ROS 2 messages it uses, as Rust types with their CDR encoding.
//!
//! The `.msg` files in `msg/` and `standard/` are the only source: the Rust types are generated from them at build time.

pub mod cdr;
mod message;

pub use message::{Encode, Message, Service, ServiceInfo, TypeInfo, service_info};
