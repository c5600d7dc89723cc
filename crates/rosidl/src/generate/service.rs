//! One service: a marker type that names its halves.

use super::{Context, documentation, rust_type};
use crate::Error;
use crate::definition::Service;

pub(super) fn generate(context: &Context, service: &Service) -> Result<String, Error> {
    let name = rust_type::short(&service.name);
    let documentation = documentation::lines(&service.comment, &format!("`{}`.", service.name), "");
    let request = rust_type::path(context, &service.request.name);
    let response = rust_type::path(context, &service.response.name);
    let (service_name, hash) = (&service.name, context.library.service_hash(service)?);
    Ok(format!(
        "{documentation}#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct {name};

impl crate::Service for {name} {{
    const NAME: &'static str = {service_name:?};
    const HASH: &'static str = {hash:?};
    type Request = {request};
    type Response = {response};
}}

"
    ))
}
