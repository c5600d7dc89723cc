//! All types by name, for tools.

use crate::{ServiceInfo, TypeInfo};

/// All messages and halves of services, ordered by name.
#[must_use]
pub fn types() -> &'static [&'static TypeInfo] {
    crate::TYPES
}

/// The type of this name, for example `trench_msgs/msg/TeamState`.
#[must_use]
pub fn type_named(name: &str) -> Option<&'static TypeInfo> {
    let index = types().binary_search_by(|info| info.name.cmp(name)).ok()?;
    types().get(index).copied()
}

/// All services, ordered by name.
#[must_use]
pub fn services() -> &'static [ServiceInfo] {
    crate::SERVICES
}
