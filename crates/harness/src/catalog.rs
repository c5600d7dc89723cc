//! All nodes, by the names of their executables.

use trench_core::NodeDescription;

/// The node whose executable is called `name`; none for programs that are no nodes of ours.
#[must_use]
pub fn node(name: &str) -> Option<NodeDescription> {
    all().into_iter().find(|node| node.name == name)
}

/// Every node that can run in lock-step.
#[must_use]
pub fn all() -> Vec<NodeDescription> {
    vec![
        formation_controller::description(),
        leader_assignment::description(),
        obstacle_mapper::description(),
        operator::description(),
        overhead_localizer::description(),
        rf_bridge::description(),
        testbed::description(),
    ]
}
