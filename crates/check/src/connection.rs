//! Whether every robot begins within reach of its leader (6.2.2), or comes to it by itself (Remark 6.2.1).

use crate::Verdict;
use crate::verdict::number;
use trench_formation::avoidance::is_obstructed;
use trench_formation::curve::Placed;
use trench_formation::kinematics::PointState;
use trench_formation::simulate::ChainScenario;
use trench_formation::trench::AnyTrench;
use trench_formation::zoning::Radii;

/// Judges the links at the start; `recovers`: the scenario, if robots that have lost their team come back to it.
pub(crate) fn connection(
    subject: &str,
    radii: &Radii,
    robots: &[PointState],
    recovers: Option<&ChainScenario<AnyTrench>>,
) -> Verdict {
    let distance = |pair: &[PointState]| (pair[1].position - pair[0].position).norm();
    let longest = robots.windows(2).map(distance).fold(0.0, f64::max);
    let lost = robots.windows(2).position(|pair| !radii.is_coordinated(distance(pair)));
    let limit = number(radii.rho_bar);
    let too_near = robots.windows(2).any(|pair| distance(pair) < radii.rho_underbar);
    let begins = |index: usize| {
        format!("r{} begins {} m from its leader", index + 2, number(distance(&robots[index..index + 2])))
    };
    let equation = "rho_underbar <= d <= rho_bar for all pairs (6.2.2)";
    let verdict = |holds: bool, finding: String| Verdict::new("connection", subject, holds, finding, equation);
    match (lost, recovers) {
        (None, _) => verdict(
            true,
            format!("no robot begins more than {} m from its leader, links reach {limit} m", number(longest)),
        ),
        (Some(index), Some(task)) if !too_near => {
            let comes =
                format!("{}, beyond the {limit} m that links reach, and comes to it along the segment", begins(index));
            // Who is led goes round what stands there; another one may rest before it for good.
            let note = task.remedies.is_none() && lies_behind_obstacles(task, &robots[index..index + 2]);
            let before = if note { ", if it gets past the obstacles on it: give remedies" } else { "" };
            Verdict { note, ..verdict(true, format!("{comes} (Remark 6.2.1){before}")) }
        }
        (Some(index), _) => verdict(
            false,
            format!("{}, but links reach {limit} m: move it nearer, or order the chain anew", begins(index)),
        ),
    }
}

/// Whether obstacles repel a robot somewhere on the segment between it and its leader, at the start.
fn lies_behind_obstacles(task: &ChainScenario<AnyTrench>, pair: &[PointState]) -> bool {
    let segment = Placed::new(&task.segment, task.carriage.at(0.0).0);
    let [to, from] = [0, 1].map(|index| segment.nearest(pair[index].position).arc_length);
    let apparent = task.combined(&task.obstacles);
    apparent.is_ok_and(|apparent| is_obstructed(&segment, &apparent, task.potential.cut(), (from, to - from)))
}
