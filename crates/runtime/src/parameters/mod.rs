//! The parameters of a running node, and the services through which they are looked at and changed.

mod list;
mod server;
mod service;
mod store;
mod value;

pub(crate) use server::ParameterServer;
pub(crate) use service::ParameterService;
pub use value::to_message;
