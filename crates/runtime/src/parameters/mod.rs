//! The parameters of a running node and the services through which they are looked at and changed.

mod describe;
mod event;
mod list;
mod server;
mod set;
mod value;

pub(crate) use server::{ParameterServer, SERVICES};
