//! Whether nodes would start, without a run: cores are made as for one, and let go.

use crate::catalog;
use crate::load::{LoadError, each_node, instance_of, program, resolved};
use trench_config::Parameters;
use trench_core::{Files, NodeDescription};
use trench_launch::Plan;

/// Of what must differ between runs of a node: nothing that a node refuses depends on it.
const SEED: u64 = 1;

/// What the nodes that `plan` starts refuse, each node's own first refusal, in the order of the file. `prepare` may change a node's
/// parameters first: what somebody else judges better need not be refused here.
pub fn refusals(plan: &Plan, files: &dyn Files, prepare: impl Fn(&NodeDescription, &mut Parameters)) -> Vec<LoadError> {
    let mut refused = Vec::new();
    for process in &plan.processes {
        let Some(node) = program(process).and_then(catalog::node) else { continue };
        let each = match each_node(&node, process) {
            Ok(each) => each,
            Err(error) => {
                refused.push(error);
                continue;
            }
        };
        for arguments in each {
            let made = resolved(&node, &arguments, process, files).and_then(|mut parameters| {
                prepare(&node, &mut parameters);
                instance_of(&node, arguments, &parameters, process, files, SEED, None)
            });
            refused.extend(made.err());
        }
    }
    refused
}
