//! Whether robots pass the gaps that are left between the hulls of a scenario (7.8).

use crate::Verdict;
use crate::verdict::number;
use trench_formation::simulate::ChainScenario;
use trench_formation::trench::AnyTrench;

const EQUATION: &str = "rho_clearance >= 2 R, and twice the pole where there are several obstacles (7.8)";

/// Whether robots, with bodies of the radius `body` (m), pass all gaps that are left: bodies fit, and no gap is all poles. Where no body is
/// named, one that is as wide as zone 1 lets it be.
pub(crate) fn clearance(subject: &str, task: &ChainScenario<AnyTrench>, body: Option<f64>) -> Verdict {
    let width = body.map_or(task.zoning.radii().rho_underbar, |body| 2.0 * body);
    let verdict = |holds, finding| Verdict::new("clearance", subject, holds, finding, EQUATION);
    let clearance = number(task.clearance);
    let wide = match body {
        Some(_) => format!("robots are {} m wide", number(width)),
        None => format!("robots, whose bodies nothing names, are up to rho_underbar = {} m wide", number(width)),
    };
    // One obstacle has no gaps: no potential comes from the other side.
    let (poles, cuts) = match task.obstacles.len() {
        0 | 1 => (0.0, 0.0),
        _ => (2.0 * task.potential.pole(), 2.0 * task.potential.cut()),
    };
    let needed = number(width.max(poles));
    if task.clearance < width {
        return verdict(
            false,
            format!("hulls {clearance} m apart are not combined, but {wide}: make the clearance {needed} m"),
        );
    }
    if task.clearance < poles {
        let finding = format!(
            "hulls {clearance} m apart are not combined, and {wide}, but the potentials of both sides have their poles {} m from the outlines: \
             gaps below {} m are closed to points, too, and who is drawn through one is stuck before it; make the clearance {needed} m, or \
             obstacle_potential.pole smaller",
            number(task.potential.pole()),
            number(poles)
        );
        return verdict(false, finding);
    }
    let fits = format!("hulls nearer than {clearance} m are combined, and {wide}: they ");
    match task.obstacles.len() {
        0 | 1 => verdict(true, format!("{fits}have no gap to pass, there is one obstacle")),
        _ if task.clearance < cuts => {
            let finding = format!(
                "{fits}fit into what is left, and poles leave a way; but in gaps below {} m, twice the cut, both sides push all over the gap: \
                 who is not drawn harder {}",
                number(cuts),
                if task.remedies.is_some() {
                    "is held before it, and goes round by its remedies"
                } else {
                    "stays before it: `remedies` lead it round"
                }
            );
            Verdict::noted("clearance", subject, finding, EQUATION)
        }
        _ => verdict(true, format!("{fits}pass what is left")),
    }
}
