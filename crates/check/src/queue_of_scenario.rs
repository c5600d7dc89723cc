//! A scenario of chapter 8: how far errors grow along its queue, and whether the queue is where its target is.

use crate::verdict::number;
use crate::{ChainOfRobots, Verdict, chain};
use trench_formation::Vector2;
use trench_formation::kinematics::PointState;
use trench_formation::simulate::QueueRobotScenario;
use trench_plan::ON_SEGMENT;
use trench_scenario::Queue;

const EQUATION: &str = "the vertex of a queue is a point of its segment (Definition 2.1.1), or the nearest one of a target that is no farther off than the spacing";

/// The bound of chapter 8, where robots are those that begin: nobody's error may be as large as the spacing, at which it could be in the
/// place of the one ahead.
pub(crate) fn queue(subject: &str, task: &Queue) -> Verdict {
    let Queue { queue, .. } = task;
    let errors = errors(task);
    let of = ChainOfRobots {
        instead_of: None,
        robots: errors.len(),
        gains: (queue.law.position_gain, queue.law.velocity_gain),
        initial_error: 0.0,
        by_rank: &errors,
        setting_out: 0.0,
        tolerance: queue.spacing,
        acceleration: None,
    };
    let found = chain(subject, &of);
    Verdict { holds: true, note: !found.holds, ..found }
}

/// |e_j(0)| of (8.9), by rank: of the first robot from its place, of others from the one ahead. Who joins later is not among them.
fn errors(Queue { queue, .. }: &Queue) -> Vec<f64> {
    let slots = queue.robots.iter().filter(|robot| robot.joins.is_none()).zip(0_u32..);
    let error = |(robot, slot): (&QueueRobotScenario, u32)| {
        let place = queue.segment.at(queue.first_place() - f64::from(slot) * queue.spacing).point;
        PointState { position: place - robot.start.position, velocity: -robot.start.velocity }
    };
    let own: Vec<PointState> = slots.map(error).collect();
    let ahead = core::iter::once(PointState::at_rest(Vector2::zeros())).chain(own.iter().copied());
    let norm = |(own, ahead): (&PointState, PointState)| {
        libm::hypot((own.position - ahead.position).norm(), (own.velocity - ahead.velocity).norm())
    };
    own.iter().zip(ahead).map(norm).collect()
}

/// Judges a target off the segment; nothing of one on it. The first robot goes to the point of the segment that is nearest, so a target as
/// far off as the spacing has nobody where the next place would be.
pub(crate) fn goal_of_queue(subject: &str, Queue { queue, .. }: &Queue) -> Option<Verdict> {
    let foot = queue.segment.nearest(queue.target);
    if foot.distance <= ON_SEGMENT {
        return None;
    }
    let (away, spacing) = (number(foot.distance), number(queue.spacing));
    let first =
        format!("the first place is [{:.4}, {:.4}], the nearest point of the segment", foot.point.x, foot.point.y);
    Some(if foot.distance > queue.spacing {
        let finding = format!(
            "target is {away} m away from the segment, and spacing is {spacing} m: {first}, and nobody comes near the target; write a point of \
             the segment as target, or lengthen the segment to it"
        );
        Verdict::new("goal", subject, false, finding, EQUATION)
    } else {
        Verdict::noted("goal", subject, format!("target is {away} m away from the segment: {first}"), EQUATION)
    })
}
