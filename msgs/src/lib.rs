//! The messages of Trench and the standard ROS 2 messages it uses, as Rust types with their CDR encoding.
//!
//! The `.msg` files in `msg/` and `standard/` are the only source: the Rust types are generated from them at build time.
//! Ours are in [`msg`], those of every other package in a module of its name: [`geometry_msgs`], [`std_srvs`] and so on.

mod camera_info;
mod finite;
mod image;
mod message;
mod registry;

pub use message::{Encode, Message, Service, ServiceInfo, TypeInfo, service_info};
pub use registry::{services, type_named, types};
pub use trench_rosidl::{cdr, dynamic};

include!(concat!(env!("OUT_DIR"), "/messages.rs"));
