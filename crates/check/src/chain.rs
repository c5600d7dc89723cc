//! How far errors may grow along a chain (chapter 8).

use crate::Verdict;
use crate::verdict::number;
use trench_formation::stability::{
    Coupling, QueueRobot, cascade_bounds, input_to_state, longest_within, recursive_bounds,
};

const EQUATION: &str = "|e_j(t)| <= sum over k of |[exp(W t)]_jk| |e_k(0)|, W of (8.28); beside it (8.26) as corrected";
/// Longer chains are not followed, and not promised anything.
const LONGEST: usize = 12;

/// A chain whose robots all have the same queue law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainOfRobots {
    /// How many.
    pub robots: usize,
    /// K = (position, velocity): 1/s^2 and 1/s.
    pub gains: (f64, f64),
    /// |e(0)| of each robot: m and m/s together.
    pub initial_error: f64,
    /// The most that any |e| may become.
    pub tolerance: f64,
}

/// Judges whether all errors of a chain stay within the tolerance, under the realisable queue law (8.11).
pub fn chain(subject: &str, chain: &ChainOfRobots) -> Verdict {
    let verdict = |holds, finding: String| Verdict::new("chain", subject, holds, finding, EQUATION);
    let (position, velocity) = chain.gains;
    let rest = chain.robots.min(LONGEST);
    let model = |count: usize| vec![QueueRobot::double_integrator_with(position, velocity); count];
    let errors = [chain.initial_error; LONGEST];
    let bounds = cascade_bounds(&model(rest), Coupling::Realisable, &errors[..rest]);
    let recursion = input_to_state(&model(rest), Coupling::Realisable, 0.5);
    match (bounds, recursion) {
        (Err(wrong), _) | (_, Err(wrong)) => {
            verdict(false, format!("K = ({}, {}): {wrong}", number(position), number(velocity)))
        }
        (Ok(bounds), Ok(recursion)) => {
            let (last, loose) = (bounds.last().copied(), recursive_bounds(&recursion, &errors[..rest]));
            let (last, loose) = (last.unwrap_or(0.0), loose.last().copied().unwrap_or(0.0));
            let longest = longest_within(&bounds, chain.tolerance);
            let holds = longest == chain.robots;
            let ranks: Vec<String> = bounds.iter().take(8).map(|bound| number(*bound)).collect();
            let more = if bounds.len() > 8 { ", ..." } else { "" };
            let limit = number(chain.tolerance);
            let verb = if holds { "stays within" } else { "may leave" };
            let mended =
                if holds { String::new() } else { format!(": at most {longest} robots in one chain stay within") };
            verdict(
                holds,
                format!(
                    "K = ({}, {}), errors of {} at the start: rank {rest} {verb} {limit} ({}; by (8.26) {}){mended}; by rank \
                     {}{more}",
                    number(position),
                    number(velocity),
                    number(chain.initial_error),
                    number(last),
                    if loose < 1e6 { number(loose) } else { format!("{loose:.0e}") },
                    ranks.join(", ")
                ),
            )
        }
    }
}
