//! Vertices that draw nobody.

use crate::{Team, Verdict};
use trench_plan::{Plan, QueuePlan};

/// Notes a queue's vertices that are nobody's goal under the team's law: who is drawn to the segment stands where the robot ahead lets it.
pub(crate) fn vertices(subject: &str, plan: &Plan, team: &Team) -> Vec<Verdict> {
    let goal_of = match team.law.as_str() {
        "zoned" | "chain" => "the first vertex draws the leader, the others draw",
        "nearest" => "vertices draw",
        _ => return Vec::new(),
    };
    let noted = |queue: &QueuePlan| {
        let (name, count, law) = (&queue.name, queue.vertices.len(), &team.law);
        let finding = format!(
            "queue {name} has {count} vertices, but under law {law} {goal_of} nobody: followers are drawn to the segment; write \
             chain: {{robots: {count}, spacing: ...}} instead of the others"
        );
        Verdict::noted("vertices", subject, finding, "(6.1), (7.4), (7.13)")
    };
    plan.queues.iter().filter(|queue| queue.chain.is_none() && queue.vertices.len() > 1).map(noted).collect()
}
