//! The chain calculator: a bound for each rank, and the longest chain within a tolerance (chapter 8).

use crate::ChainOfRobots;
use trench_formation::stability::{
    ChainError, Coupling, QueueRobot, input_to_state, longest_within, recursive_bounds, uniform_bounds,
};

/// Longer chains are not followed to their end, and not promised anything.
pub(crate) const LONGEST: usize = 100;

/// How far errors grow, |e_j|: m and m/s together.
pub(crate) struct Bounds {
    /// By rank, of the chain's own robots, the first hundred of them.
    pub(crate) bounds: Vec<f64>,
    /// The same by (8.26) as corrected.
    pub(crate) recursive: Vec<f64>,
    /// So many robots in one chain stay within the tolerance, of `computed` at most.
    pub(crate) longest: usize,
    /// For so many ranks bounds were computed to find that.
    pub(crate) computed: usize,
}

impl Bounds {
    /// Follows the chain to its end, and beyond it until a rank leaves the tolerance: ranks ahead know nothing of those behind.
    ///
    /// # Errors
    /// Gains that leave the closed loop unstable.
    pub(crate) fn of(chain: &ChainOfRobots<'_>) -> Result<Self, ChainError> {
        let robot = QueueRobot::double_integrator_with(chain.gains.0, chain.gains.1);
        // All robots behind the first are alike.
        let recursion = input_to_state(&[robot.clone(), robot.clone()], Coupling::Realisable, 0.5)?;
        let own = chain.robots.min(LONGEST);
        let mut computed = own;
        let (mut bounds, longest) = loop {
            let bounds = uniform_bounds(&robot, Coupling::Realisable, &errors(chain, computed))?;
            let longest = longest_within(&bounds, chain.tolerance);
            // Twice as many at a time: what slow chains cost grows with the square of their ranks. Of robots whose errors are known, each
            // for itself, there are no more.
            match longest < computed || computed == LONGEST || !chain.by_rank.is_empty() {
                true => break (bounds, longest),
                false => computed = (2 * computed).clamp(1, LONGEST),
            }
        };
        bounds.truncate(own);
        let recursion: Vec<_> = (0..own).map(|rank| recursion[rank.min(1)]).collect();
        Ok(Self { recursive: recursive_bounds(&recursion, &errors(chain, own)), bounds, longest, computed })
    }
}

/// |e_j(0)| of so many robots.
fn errors(chain: &ChainOfRobots<'_>, robots: usize) -> Vec<f64> {
    if !chain.by_rank.is_empty() {
        return chain.by_rank.iter().copied().take(robots).collect();
    }
    (0..robots).map(|rank| if rank == 0 { chain.first_error() } else { chain.initial_error }).collect()
}
