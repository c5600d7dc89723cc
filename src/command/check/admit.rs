//! What nodes refuse: their own readers say so, as they would at their start, so that nothing holds here and is refused there.

use super::gather::CheckError;
use trench_config::{Origin, ParameterValue, Parameters};
use trench_core::{NodeContext, NodeDescription};
use trench_harness::{Disk, catalog};
use trench_launch::Plan;

pub(super) const CONTROLLER: &str = "formation_controller";

/// Refuses a launch file whose nodes would not start.
pub(super) fn launched(plan: &Plan) -> Result<(), CheckError> {
    let refused = trench_harness::refusals(plan, &Disk, leave_gains_to_verdicts);
    if refused.is_empty() { Ok(()) } else { Err(CheckError::Refused(refused)) }
}

/// Refuses parameters that no controller in `namespace` would take.
pub(super) fn controller(namespace: &str, parameters: &Parameters) -> Result<(), CheckError> {
    let node = catalog::node(CONTROLLER).ok_or(CheckError::NoNode(CONTROLLER))?;
    let context =
        NodeContext { namespace: namespace.to_owned(), name: CONTROLLER.to_owned(), seed: 1, ..NodeContext::default() };
    let mut parameters = parameters.clone();
    leave_gains_to_verdicts(&node, &mut parameters);
    (node.build)(&context, &parameters, &Disk)?;
    Ok(())
}

/// Verdicts say more of gains and damping than the refusal does: all that is wrong with them, by which equation.
fn leave_gains_to_verdicts(node: &NodeDescription, parameters: &mut Parameters) {
    if node.name == CONTROLLER {
        parameters.insert("refuse_unstable_gains", ParameterValue::Bool(false), Origin::default());
    }
}
