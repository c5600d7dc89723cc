//! Gains of the kinematic laws.

use crate::Verdict;
use crate::verdict::number;
use trench_formation::laws::{Family, Robust};
use trench_formation::stability::StableZone;

/// Judges the gains of a law by its name; K3 counts for `robust` alone.
pub(crate) fn gains(name: &str, law: &str, gains: Robust) -> Verdict {
    let Robust { k1, k2, k3 } = gains;
    let equation = match law {
        "robust" => "K1 + 2 c2 K2 < K3 < K1 + 2 c1 K2, the stable zone of (3.13) (section 4.3.1)",
        "family" => "K1 > 0, K2 > 0 of (4.4)",
        "nominal" => "K1 > 0, K2 > 0 of (3.10)",
        _ => "K1 > 0, K2 > 0 of (3.9)",
    };
    match StableZone::check(gains) {
        Err(violation) => Verdict::new("gains", name, false, violation.to_string(), equation),
        Ok(()) if law == "robust" => {
            let (low, high) = StableZone::turn_bounds(k1, k2);
            let rate = StableZone::guaranteed_rate(gains);
            let finding = format!(
                "K1 = {}, K2 = {}: {} < K3 = {} < {}; misalignment falls at least as e^(-{} t)",
                number(k1),
                number(k2),
                number(low),
                number(k3),
                number(high),
                number(rate)
            );
            Verdict::new("gains", name, true, finding, equation)
        }
        Ok(()) => Verdict::new("gains", name, true, format!("K1 = {}, K2 = {}", number(k1), number(k2)), equation),
    }
}

/// Judges the exponents of the family (4.4).
pub(crate) fn exponents(name: &str, law: &Family) -> Verdict {
    let (q, reaches) = (law.q, law.is_asymptotically_stable());
    let finding = if reaches {
        format!("q = {q}: the robot reaches its goal point")
    } else {
        format!("q = {q}: the robot stops short of its goal point; the nearest admissible q is 0")
    };
    Verdict::new("exponents", name, reaches, finding, "q = 0, Proposition 4.1.1 as corrected")
}
