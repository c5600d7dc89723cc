//! One controller's law and its gains.

use crate::Verdict;
use crate::gains::{exponents, gains};
use crate::limits::{Largest, of_controller};
use crate::potential::potential;
use crate::verdict::number;
use crate::walls_of_controller::walls_of_controller;
use crate::zones::zones;
use trench_config::{ConfigError, Parameters};
use trench_formation::laws::{Family, Robust};
use trench_formation::trench::check_admissibility;
use trench_plan::{TRENCH_RANGE, trench_from_parameters};

/// A formation_controller by its full name, with its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Controller {
    /// For verdicts.
    pub name: String,
    /// All its parameters.
    pub parameters: Parameters,
}

/// Chains with less damping than this (1/s) and none towards their leaders whip (ERRATA on 6.5 and 7.10).
const LEAST_CHAIN_DAMPING: f64 = 2.0;

/// Judges the law of a controller: gains, potential, zones, damping, limits.
///
/// # Errors
/// When a parameter is missing or of another type than controllers declare.
pub fn controller(controller: &Controller) -> Result<Vec<Verdict>, ConfigError> {
    let (name, parameters) = (&controller.name, &controller.parameters);
    match parameters.str("law")? {
        law @ ("robust" | "nominal" | "direct" | "family") => kinematic(name, law, parameters),
        law => dynamic(name, law, parameters),
    }
}

fn kinematic(name: &str, law: &str, parameters: &Parameters) -> Result<Vec<Verdict>, ConfigError> {
    let (k1, k2) = (parameters.f64("gains.k1")?, parameters.f64("gains.k2")?);
    let k3 = if law == "robust" { parameters.f64("gains.k3")? } else { k1 };
    let mut verdicts = vec![gains(name, law, Robust { k1, k2, k3 })];
    if law == "family" {
        let exponent = |key: &str| Ok::<_, ConfigError>(u32::try_from(parameters.usize(key)?).unwrap_or(u32::MAX));
        let (n, p, q, s) = (exponent("family.n")?, exponent("family.p")?, exponent("family.q")?, exponent("family.s")?);
        verdicts.push(exponents(name, &Family { k1, k2, n, p, q, s }));
    }
    Ok(verdicts)
}

fn dynamic(name: &str, law: &str, parameters: &Parameters) -> Result<Vec<Verdict>, ConfigError> {
    if law == "queue" {
        let (k1, k2) = (parameters.f64("queue.position_gain")?, parameters.f64("queue.velocity_gain")?);
        let finding = format!("K = ({}, {}): F = A - B K is Hurwitz", number(k1), number(k2));
        return Ok(vec![Verdict::new(
            "gains",
            name,
            k1 > 0.0 && k2 > 0.0,
            finding,
            "(8.18), Theorem 8.2.1 as corrected",
        )]);
    }
    let shape = parameters.str("trench.shape")?;
    let trench = trench_from_parameters(parameters)?;
    let verdict = potential(name, &trench, TRENCH_RANGE);
    let mut verdicts = vec![Verdict { finding: format!("{shape}: {}", verdict.finding), ..verdict }];
    let damping = parameters.f64("damping")?;
    if matches!(law, "zoned" | "chain") {
        verdicts.push(zones(name, parameters.f64_array("zones.radii")?, parameters.f64("body.radius")?));
        let leader_damping = parameters.f64("leader_damping")?;
        verdicts.push(chain_damping(name, damping, leader_damping));
    } else if law != "goal_damped" {
        let finding = format!("k = {}: V' = -k |r'|^2", number(damping));
        verdicts.push(Verdict::new("damping", name, damping > 0.0, finding, "k > 0 (Theorem 5.3.1, A.10)"));
    }
    // The trench of (5.2) is its own, and has no bound.
    if law != "goal_damped" {
        let pull = check_admissibility(&trench, TRENCH_RANGE).map_or(f64::INFINITY, |found| found.lipschitz_constant);
        let full = parameters.f64("zones.full_acceleration")?;
        let zones = if matches!(law, "zoned" | "chain") { full } else { 0.0 };
        // How many robots and obstacles there will be is not a controller's to know.
        let largest = Largest { trench: pull, zones, obstacles: full, at_once: [usize::MAX; 2] };
        let oblique = law == "zoned" && !parameters.f64_list("zoned.direction")?.is_empty();
        verdicts.push(of_controller(name, &largest, parameters.f64("motion.acceleration")?, oblique));
        verdicts.extend(walls_of_controller(name, law, &trench, parameters)?);
    }
    Ok(verdicts)
}

/// Judges the damping of a chain with zones.
pub(crate) fn chain_damping(name: &str, damping: f64, leader_damping: f64) -> Verdict {
    let holds = damping >= LEAST_CHAIN_DAMPING || leader_damping >= 1.0;
    let (k, c) = (number(damping), number(leader_damping));
    let finding = if holds {
        format!("k = {k}, c = {c}: the chain does not whip")
    } else {
        format!(
            "k = {k}, c = {c}: zoning forces act as elastic walls and the chain whips; the nearest admissible k is {}, or set \
             leader_damping to 1 or more",
            number(LEAST_CHAIN_DAMPING)
        )
    };
    Verdict::new("damping", name, holds, finding, "k >= 2 or c >= 1 (ERRATA on 6.5 and 7.10)")
}
