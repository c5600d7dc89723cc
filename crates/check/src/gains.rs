//! Gains of the kinematic laws.

use crate::verdict::number;
use crate::{Values, Verdict};
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
        // Without K1 and K2 that are sound there is no zone to be in the middle of.
        Err(violation) if law == "robust" && k1 > 0.0 && k2 > 0.0 && violation.gain() == "K3" => {
            let (advice, values) = advised(k1, k2);
            let finding = format!("{violation}{advice}");
            Verdict { values: Some(values), ..Verdict::new("gains", name, false, finding, equation) }
        }
        Err(violation) => Verdict::new("gains", name, false, violation.to_string(), equation),
        Ok(()) if law == "robust" => {
            let (low, high) = StableZone::turn_bounds(k1, k2);
            let rate = StableZone::guaranteed_rate(gains);
            let (advice, values) = advised(k1, k2);
            let finding = format!(
                "K1 = {}, K2 = {}: {} < K3 = {} < {}; misalignment falls at least as e^(-{} t){advice}",
                number(k1),
                number(k2),
                number(low),
                number(k3),
                number(high),
                number(rate)
            );
            Verdict { values: Some(values), ..Verdict::new("gains", name, true, finding, equation) }
        }
        Ok(()) => Verdict::new("gains", name, true, format!("K1 = {}, K2 = {}", number(k1), number(k2)), equation),
    }
}

/// What 4.3.2 advises for K1 and K2.
fn advised(k1: f64, k2: f64) -> (String, Values) {
    let (centred, above) = (StableZone::centred(k1, k2), StableZone::centred_above(k1, k2));
    let rate = StableZone::guaranteed_rate;
    let text = format!(
        "; the guidelines of 4.3.2: K3 = {}, the middle of the zone (e^(-{} t)), or K3 = {}, the middle of its part above K1, which turns robots \
         faster within a right angle (e^(-{} t))",
        number(centred.k3),
        number(rate(centred)),
        number(above.k3),
        number(rate(above))
    );
    (text, Values::Gains { k3_centred: centred.k3, k3_centred_above: above.k3 })
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
