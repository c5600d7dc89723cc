//! One controller's law and its gains.

use crate::Verdict;
use crate::gains::{exponents, gains};
use crate::limits::{Largest, of_controller};
use crate::potential::potential;
use crate::verdict::number;
use crate::walls::{Coming, Wall, walls};
use crate::zones::zones;
use trench_config::{ConfigError, Parameters};
use trench_formation::laws::{Family, Robust};
use trench_formation::trench::{AnyTrench, check_admissibility};
use trench_formation::zoning::{Edge, ObstaclePotential, Radii, Sharpness, Zoning};
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
        verdicts.extend(walls_of(name, law, &trench, parameters)?);
    }
    Ok(verdicts)
}

/// Whether zones and obstacles hold against the trench, as far as robots can be from what draws them: across the field.
fn walls_of(
    name: &str,
    law: &str,
    trench: &AnyTrench,
    parameters: &Parameters,
) -> Result<Option<Verdict>, ConfigError> {
    let [low_x, low_y, high_x, high_y] = parameters.f64_array("field")?;
    let reach = libm::hypot(high_x - low_x, high_y - low_y).clamp(1e-3, TRENCH_RANGE);
    let pull = check_admissibility(trench, reach).map_or(f64::INFINITY, |found| found.lipschitz_constant);
    // Zones and obstacles that make no potential are for other verdicts, and for the node.
    let key = "zones.full_acceleration";
    let mut all: Vec<Wall> =
        potential_of_obstacles(parameters)?.iter().map(|potential| Wall::obstacles(potential, key, 0.0)).collect();
    if matches!(law, "zoned" | "chain") {
        all.extend(zoning(parameters)?.map(|zoning| Wall::zones(&zoning, key)));
    }
    let (speed, because) = (parameters.f64("motion.speed")?, "motion.speed");
    Ok(walls(name, &Coming { pull, speed, because }, &all))
}

fn edge(parameters: &Parameters) -> Result<Edge, ConfigError> {
    Ok(if parameters.bool("zones.continuous")? { Edge::Continuous } else { Edge::Jump })
}

fn sharpness(parameters: &Parameters) -> Result<Sharpness, ConfigError> {
    Ok(if parameters.i64("zones.sharpness")? == 1 { Sharpness::One } else { Sharpness::Two })
}

fn zoning(parameters: &Parameters) -> Result<Option<Zoning>, ConfigError> {
    let [underbar, hat, rho, check, bar] = parameters.f64_array("zones.radii")?;
    let strength = (parameters.f64("zones.repulsion")?, parameters.f64("zones.attraction")?);
    let (sharpness, edge) = (sharpness(parameters)?, edge(parameters)?);
    let full = parameters.f64("zones.full_acceleration")?;
    let radii = Radii::new(underbar, hat, rho, check, bar).ok();
    Ok(radii.and_then(|radii| Zoning::new(radii, strength, sharpness, edge, full).ok()))
}

fn potential_of_obstacles(parameters: &Parameters) -> Result<Option<ObstaclePotential>, ConfigError> {
    let (pole, cut) = (parameters.f64("obstacles.pole")?, parameters.f64("obstacles.cut")?);
    let (strength, full) = (parameters.f64("obstacles.strength")?, parameters.f64("zones.full_acceleration")?);
    Ok(ObstaclePotential::new(pole, cut, strength, sharpness(parameters)?, edge(parameters)?, full).ok())
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
