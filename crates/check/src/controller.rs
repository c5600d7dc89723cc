//! One controller's law and its gains.

use crate::Verdict;
use crate::damping::{Damped, chain_damping};
use crate::gains::{exponents, gains};
use crate::limits::{Largest, of_controller};
use crate::potential::potential;
use crate::stiffness::steepest;
use crate::verdict::number;
use crate::walls_of_controller::{potential_of_obstacles, reach, walls_of_controller, zoning};
use crate::zones::zones;
use trench_config::{ConfigError, Parameters};
use trench_formation::laws::{Family, Robust};
use trench_formation::trench::AnyTrench;
use trench_plan::{TRENCH_RANGE, trench_from_parameters};

/// A formation_controller by its full name, with its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Controller {
    /// For verdicts.
    pub name: String,
    /// All its parameters.
    pub parameters: Parameters,
}

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
        verdicts
            .extend(damped(trench_pull(&trench, parameters)?, parameters)?.map(|damped| chain_damping(name, &damped)));
    } else if law != "goal_damped" {
        let finding = format!("k = {}: V' = -k |r'|^2", number(damping));
        verdicts.push(Verdict::new("damping", name, damping > 0.0, finding, "k > 0 (Theorem 5.3.1, A.10)"));
    }
    // The trench of (5.2) is its own, and has no bound.
    if law != "goal_damped" {
        let pull = steepest(&trench, TRENCH_RANGE);
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

/// The trench's largest pull across the field, which robots follow up to their acceleration, m/s^2.
fn trench_pull(trench: &AnyTrench, parameters: &Parameters) -> Result<f64, ConfigError> {
    let pull = steepest(trench, reach(parameters)?);
    Ok(pull.min(parameters.f64("motion.acceleration")?))
}

/// What decides whether its chain whips; nothing where zones make no potential, which another verdict says.
fn damped(pull: f64, parameters: &Parameters) -> Result<Option<Damped>, ConfigError> {
    let obstacles = potential_of_obstacles(parameters)?;
    let (damping, leader_damping) = (parameters.f64("damping")?, parameters.f64("leader_damping")?);
    let speed = parameters.f64("motion.speed")?;
    let of = |zones| Damped { damping, leader_damping, pull, speed, robots: None, zones, obstacles };
    Ok(zoning(parameters)?.map(of))
}
