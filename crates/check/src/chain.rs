//! How far errors may grow along a chain (chapter 8).

use crate::bounds::{Bounds, LONGEST};
use crate::verdict::number;
use crate::{Values, Verdict};

const EQUATION: &str = "|e_j(t)| <= sum over k of |[exp(W t)]_jk| |e_k(0)|, W of (8.28); beside it (8.26) as corrected";
/// People are told of so many ranks, programs of all.
const TOLD: usize = 8;

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
    /// |e_j(0)| by rank, of as many as there are robots, where each is known: then `initial_error` and `setting_out` count for nothing. Else
    /// empty.
    pub by_rank: &'a [f64],
    /// m/s, at which the goal points set out from rest: the first robot's error has that much besides.
    pub setting_out: f64,
    /// The most that any |e| may become.
    pub tolerance: f64,
    /// m/s^2, what the robots can do; none where that is judged elsewhere.
    pub acceleration: Option<f64>,
}

impl ChainOfRobots<'_> {
    /// |e_1(0)|.
    pub(crate) fn first_error(&self) -> f64 {
        libm::hypot(self.initial_error, self.setting_out)
    }
}

/// Judges whether all errors of a chain stay within the tolerance, under the realisable queue law (8.11).
pub fn chain(subject: &str, chain: &ChainOfRobots<'_>) -> Verdict {
    let Bounds { bounds, recursive, longest, computed } = match Bounds::of(chain) {
        Ok(bounds) => bounds,
        Err(wrong) => {
            return Verdict::new("chain", subject, false, format!("{}: {wrong}", gains(chain)), EQUATION);
        }
    };
    let asked = libm::hypot(chain.gains.0, chain.gains.1) * bounds.iter().copied().fold(0.0, f64::max);
    let beyond = chain.acceleration.filter(|able| asked > *able);
    let (rest, holds) = (bounds.len(), longest >= chain.robots);
    // Who leaves is the first rank beyond: those behind may have smaller bounds.
    let (rank, verb) = if longest >= rest { (rest, "stays within") } else { (longest + 1, "may leave") };
    let of = |bounds: &[f64]| rank.checked_sub(1).and_then(|index| bounds.get(index)).copied().unwrap_or(0.0);
    let (bound, loose) = (of(&bounds), of(&recursive));
    let mended = if !chain.by_rank.is_empty() && rest == chain.robots {
        // Longer chains are of robots that nobody knows.
        match longest {
            _ if holds => String::new(),
            0 => ": not even the first stays within".to_owned(),
            1 => ": the first alone stays within".to_owned(),
            _ => format!(": the first {longest} stay within"),
        }
    } else if holds {
        format!(", as {}{longest} robots in one chain would", if longest < computed { "up to " } else { "" })
    } else if longest >= rest {
        format!(": ranks beyond {LONGEST} are not computed, and not promised anything")
    } else {
        format!(": at most {longest} robots in one chain stay within")
    };
    let ranks: Vec<String> = bounds.iter().take(TOLD).map(|bound| number(*bound)).collect();
    let more = if rest > TOLD { ", ..." } else { "" };
    let finding = format!(
        "the linear queue law (8.11) with {} and errors of {} at the start: rank {rank} {verb} {} ({}; by (8.26) {}){mended}; by rank {}{more}{}{}",
        gains(chain),
        at_the_start(chain),
        number(chain.tolerance),
        number(bound),
        if loose < 1e6 { number(loose) } else { format!("{loose:.0e}") },
        ranks.join(", "),
        another_law(chain),
        beyond.map_or(String::new(), |able| limits(asked, able)),
    );
    let values = Values::Chain { bounds, recursive_bounds: recursive, longest, computed };
    Verdict {
        note: holds && beyond.is_some(),
        values: Some(values),
        ..Verdict::new("chain", subject, holds, finding, EQUATION)
    }
}

fn gains(chain: &ChainOfRobots<'_>) -> String {
    format!("K = ({}, {})", number(chain.gains.0), number(chain.gains.1))
}

fn at_the_start(chain: &ChainOfRobots<'_>) -> String {
    if !chain.by_rank.is_empty() {
        let ranks: Vec<String> = chain.by_rank.iter().take(TOLD).map(|error| number(*error)).collect();
        return ranks.join(", ") + if chain.by_rank.len() > TOLD { ", ..." } else { "" };
    }
    let each = number(chain.initial_error);
    if chain.setting_out <= 0.0 || chain.robots == 0 {
        return each;
    }
    let (error, speed) = (number(chain.first_error()), number(chain.setting_out));
    format!("{each} ({error} of the first, whose goal point sets out at {speed} m/s)")
}

fn another_law(chain: &ChainOfRobots<'_>) -> String {
    chain.instead_of.map_or(String::new(), |law| {
        format!("; law {law} has these gains at the bottom of its trench, but is not this law: zones, limits, obstacles are not in the bound")
    })
}

fn limits(asked: f64, able: f64) -> String {
    format!(
        "; |K e| may ask for {} m/s^2, robots have {} (motion.acceleration): the bound is that of robots that are not at this limit",
        number(asked),
        number(able)
    )
}
