//! One controller's law and its gains.

use crate::Verdict;
use crate::potential::potential;
use crate::verdict::number;
use crate::zones::zones;
use trench_config::{ConfigError, Parameters};
use trench_formation::laws::{Family, Robust};
use trench_formation::stability::StableZone;
use trench_formation::trench::{Conic, Hyperbolic, Quadratic, Saturated, SquareRoot};

/// A formation_controller by its full name, with its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Controller {
    /// For verdicts.
    pub name: String,
    /// All its parameters.
    pub parameters: Parameters,
}

/// Trenches are looked at up to this distance, m.
const TRENCH_RANGE: f64 = 100.0;
/// Chains with less damping than this (1/s) and none towards their leaders whip (ERRATA on 6.5 and 7.10).
const LEAST_CHAIN_DAMPING: f64 = 2.0;

/// Judges the law of a controller: gains, potential, zones, damping.
///
/// # Errors
/// When a parameter is missing or of another type than controllers declare.
pub fn controller(controller: &Controller) -> Result<Vec<Verdict>, ConfigError> {
    let (name, parameters) = (&controller.name, &controller.parameters);
    match parameters.str("law")? {
        law @ ("robust" | "nominal" | "direct" | "family") => gains(name, law, parameters),
        law => dynamic(name, law, parameters),
    }
}

fn gains(name: &str, law: &str, parameters: &Parameters) -> Result<Vec<Verdict>, ConfigError> {
    let (k1, k2) = (parameters.f64("gains.k1")?, parameters.f64("gains.k2")?);
    let k3 = if law == "robust" { parameters.f64("gains.k3")? } else { k1 };
    let gains = Robust { k1, k2, k3 };
    let equation = match law {
        "robust" => "K1 + 2 c2 K2 < K3 < K1 + 2 c1 K2, the stable zone of (3.13) (section 4.3.1)",
        "family" => "K1 > 0, K2 > 0 of (4.4)",
        "nominal" => "K1 > 0, K2 > 0 of (3.10)",
        _ => "K1 > 0, K2 > 0 of (3.9)",
    };
    let mut verdicts = vec![match StableZone::check(gains) {
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
    }];
    if law == "family" {
        verdicts.push(family(name, gains, parameters)?);
    }
    Ok(verdicts)
}

fn family(name: &str, gains: Robust, parameters: &Parameters) -> Result<Verdict, ConfigError> {
    let exponent = |key: &str| Ok::<_, ConfigError>(u32::try_from(parameters.usize(key)?).unwrap_or(u32::MAX));
    let (n, p, q, s) = (exponent("family.n")?, exponent("family.p")?, exponent("family.q")?, exponent("family.s")?);
    let reaches = Family { k1: gains.k1, k2: gains.k2, n, p, q, s }.is_asymptotically_stable();
    let finding = if reaches {
        format!("q = {q}: the robot reaches its goal point")
    } else {
        format!("q = {q}: the robot stops short of its goal point; the nearest admissible q is 0")
    };
    Ok(Verdict::new("exponents", name, reaches, finding, "q = 0, Proposition 4.1.1 as corrected"))
}

fn dynamic(name: &str, law: &str, parameters: &Parameters) -> Result<Vec<Verdict>, ConfigError> {
    let (alpha, a) = (parameters.f64("trench.alpha")?, parameters.f64("trench.a")?);
    let judged =
        |what: &str, verdict: Verdict| vec![Verdict { finding: format!("{what}: {}", verdict.finding), ..verdict }];
    let mut verdicts = match parameters.str("trench.shape")? {
        "hyperbolic" => judged("hyperbolic", potential(name, &Hyperbolic { alpha, a }, TRENCH_RANGE)),
        "quadratic" => judged("quadratic", potential(name, &Quadratic { alpha: alpha / a }, TRENCH_RANGE)),
        "saturated" => judged("saturated", potential(name, &Saturated { stiffness: alpha / a, edge: a }, TRENCH_RANGE)),
        "conic" => judged("conic", potential(name, &Conic { alpha }, TRENCH_RANGE)),
        "square_root" => judged("square_root", potential(name, &SquareRoot, TRENCH_RANGE)),
        _ => Vec::new(),
    };
    let damping = parameters.f64("damping")?;
    if matches!(law, "zoned" | "chain") {
        verdicts.push(zones(name, parameters.f64_array("zones.radii")?, parameters.f64("body.radius")?));
        let leader_damping = parameters.f64("leader_damping")?;
        let holds = damping >= LEAST_CHAIN_DAMPING || leader_damping >= 1.0;
        let finding = if holds {
            format!("k = {}, c = {}: the chain does not whip", number(damping), number(leader_damping))
        } else {
            format!(
                "k = {}, c = {}: zoning forces act as elastic walls and the chain whips; the nearest admissible k is {}, \
                 or set leader_damping to 1 or more",
                number(damping),
                number(leader_damping),
                number(LEAST_CHAIN_DAMPING)
            )
        };
        verdicts.push(Verdict::new("damping", name, holds, finding, "k >= 2 or c >= 1 (ERRATA on 6.5 and 7.10)"));
    } else if law != "goal_damped" {
        let finding = format!("k = {}: V' = -k |r'|^2", number(damping));
        verdicts.push(Verdict::new("damping", name, damping > 0.0, finding, "k > 0 (Theorem 5.3.1, A.10)"));
    }
    Ok(verdicts)
}
