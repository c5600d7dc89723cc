//! Where the chain leader goes.

use crate::Verdict;
use crate::verdict::number;
use trench_formation::Vector2;
use trench_formation::curve::Curve;
use trench_formation::zoning::Radii;
use trench_plan::ON_SEGMENT;

const EQUATION: &str =
    "the team goal is a vertex, a point of the segment (Definition 2.1.1), or a target (6.2.1) at most rho from it";

/// Judges a team goal off the segment (m, in the segment's frame); nothing of one on it. It may be a target to be tracked, where r1 stays;
/// but farther away than rho nobody on the segment has r1 in its neutral zone.
pub(crate) fn goal(
    subject: &str,
    segment: &Curve,
    goal: Vector2<f64>,
    radii: &Radii,
    robots: usize,
) -> Option<Verdict> {
    let foot = segment.nearest(goal);
    if foot.distance <= ON_SEGMENT {
        return None;
    }
    let (away, rho) = (number(foot.distance), number(radii.rho));
    let nearest = format!("the nearest point of the segment is [{:.4}, {:.4}]", foot.point.x, foot.point.y);
    Some(if robots > 1 && foot.distance > radii.rho {
        let finding = format!(
            "team_goal is {away} m away from the segment, and rho is {rho} m: r1 goes there, and nobody on the segment has it in its neutral \
             zone; write a point of the segment, or a target within rho: {nearest}"
        );
        Verdict::new("goal", subject, false, finding, EQUATION)
    } else {
        let finding = format!(
            "team_goal is {away} m away from the segment: r1 comes to rest there, and not on the segment; {nearest}"
        );
        Verdict::noted("goal", subject, finding, EQUATION)
    })
}
