//! How far errors may grow along a chain (chapter 8).

use crate::Verdict;
use crate::verdict::number;
use trench_formation::stability::{
    Coupling, QueueRobot, input_to_state, longest_within, recursive_bounds, uniform_bounds,
};

const EQUATION: &str = "|e_j(t)| <= sum over k of |[exp(W t)]_jk| |e_k(0)|, W of (8.28); beside it (8.26) as corrected";
/// Longer chains are not followed to their end, and not promised anything.
const LONGEST: usize = 100;

/// A chain whose robots all have the same queue law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainOfRobots<'a> {
    /// The law that the robots go by in truth, if it is not the queue law: then the bound is that of another law with its gains.
    pub instead_of: Option<&'a str>,
    /// How many.
    pub robots: usize,
    /// K = (position, velocity): 1/s^2 and 1/s.
    pub gains: (f64, f64),
    /// |e(0)| of each robot: m and m/s together.
    pub initial_error: f64,
    /// m/s, at which the goal points set out from rest: the first robot's error has that much besides.
    pub setting_out: f64,
    /// The most that any |e| may become.
    pub tolerance: f64,
    /// m/s^2, what the robots can do; none where that is judged elsewhere.
    pub acceleration: Option<f64>,
}

/// Judges whether all errors of a chain stay within the tolerance, under the realisable queue law (8.11).
pub fn chain(subject: &str, chain: &ChainOfRobots<'_>) -> Verdict {
    let verdict = |holds, finding: String| Verdict::new("chain", subject, holds, finding, EQUATION);
    let (position, velocity) = chain.gains;
    let rest = chain.robots.min(LONGEST);
    let robot = QueueRobot::double_integrator_with(position, velocity);
    let mut errors = vec![chain.initial_error; rest];
    if let Some(first) = errors.first_mut() {
        *first = libm::hypot(*first, chain.setting_out);
    }
    let bounds = uniform_bounds(&robot, Coupling::Realisable, &errors);
    // All robots behind the first are alike.
    let recursion = input_to_state(&[robot.clone(), robot], Coupling::Realisable, 0.5);
    let gains = format!("K = ({}, {})", number(position), number(velocity));
    let (bounds, recursion) = match (bounds, recursion) {
        (Err(wrong), _) | (_, Err(wrong)) => return verdict(false, format!("{gains}: {wrong}")),
        (Ok(bounds), Ok(recursion)) => (bounds, recursion),
    };
    let recursion: Vec<_> = (0..rest).map(|rank| recursion[rank.min(1)]).collect();
    let asked = libm::hypot(position, velocity) * bounds.iter().copied().fold(0.0, f64::max);
    let beyond = chain.acceleration.filter(|able| asked > *able);
    let (last, loose) = (bounds.last().copied(), recursive_bounds(&recursion, &errors));
    let (last, loose) = (last.unwrap_or(0.0), loose.last().copied().unwrap_or(0.0));
    let longest = longest_within(&bounds, chain.tolerance);
    let holds = longest == chain.robots;
    let ranks: Vec<String> = bounds.iter().take(8).map(|bound| number(*bound)).collect();
    let more = if bounds.len() > 8 { ", ..." } else { "" };
    let limit = number(chain.tolerance);
    let verb = if longest == rest { "stays within" } else { "may leave" };
    let mended = if holds {
        String::new()
    } else if longest == rest {
        format!(": ranks beyond {LONGEST} are not computed, and not promised anything")
    } else {
        format!(": at most {longest} robots in one chain stay within")
    };
    let law = chain.instead_of.map_or(String::new(), |law| {
        format!("; law {law} has these gains at the bottom of its trench, but is not this law: zones, limits, obstacles are not in the bound")
    });
    let first = if chain.setting_out > 0.0 && rest > 0 {
        format!(" ({} of the first, whose goal point sets out at {} m/s)", number(errors[0]), number(chain.setting_out))
    } else {
        String::new()
    };
    let limits = beyond.map_or(String::new(), |able| {
        format!(
            "; |K e| may ask for {} m/s^2, robots have {} (motion.acceleration): the bound is that of robots that are not at this limit",
            number(asked),
            number(able)
        )
    });
    let found = verdict(
        holds,
        format!(
            "the linear queue law (8.11) with {gains} and errors of {}{first} at the start: rank {rest} {verb} {limit} ({}; by (8.26) \
             {}){mended}; by rank {}{more}{law}{limits}",
            number(chain.initial_error),
            number(last),
            if loose < 1e6 { number(loose) } else { format!("{loose:.0e}") },
            ranks.join(", ")
        ),
    );
    Verdict { note: holds && beyond.is_some(), ..found }
}
