//! Trench functions against Definition 5.2.1.

use crate::Verdict;
use crate::verdict::number;
use trench_formation::trench::{Trench, check_admissibility};

const EQUATION: &str = "Definition 5.2.1: Lipschitz, Phi > 0 and 0 only at 0, 0 in its gradient; and x phi(x) > 0";

/// Judges a trench on [-range, range] (m).
pub fn potential(subject: &str, trench: &impl Trench, range: f64) -> Verdict {
    match check_admissibility(trench, range) {
        Err(wrong) => Verdict::new("potential", subject, false, wrong.to_string(), EQUATION),
        Ok(admissible) => {
            let how = if admissible.proved_from.is_some() { "proved" } else { "at 4000 points" };
            let most = number(admissible.lipschitz_constant);
            let finding = format!("admissible up to {} m ({how}), pulls with at most {most} m/s^2", number(range));
            Verdict::new("potential", subject, true, finding, EQUATION)
        }
    }
}
