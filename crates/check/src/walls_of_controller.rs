//! What zones and obstacles of a controller are held against.

use crate::Verdict;
use crate::stiffness::steepest;
use crate::walls::{Coming, Wall, walls};
use trench_config::{ConfigError, Parameters};
use trench_formation::trench::AnyTrench;
use trench_formation::zoning::{Edge, ObstaclePotential, Radii, Sharpness, Zoning};
use trench_plan::TRENCH_RANGE;

/// Whether zones and obstacles hold against the trench, as far as robots can be from what draws them: across the field.
pub(crate) fn walls_of_controller(
    name: &str,
    law: &str,
    trench: &AnyTrench,
    parameters: &Parameters,
) -> Result<Option<Verdict>, ConfigError> {
    let pull = steepest(trench, reach(parameters)?);
    // Zones and obstacles that make no potential are for other verdicts, and for the node.
    let key = "zones.full_acceleration";
    let mut all: Vec<Wall> =
        potential_of_obstacles(parameters)?.iter().map(|potential| Wall::obstacles(potential, key, 0.0)).collect();
    if matches!(law, "zoned" | "chain") {
        all.extend(zoning(parameters)?.map(|zoning| Wall::zones(&zoning, key)));
    }
    let (speed, because) = (parameters.f64("motion.speed")?, "motion.speed".to_owned());
    Ok(walls(name, &Coming { pull, speed, because }, &all))
}

/// As far as robots can be from what draws them, m: across the field.
pub(crate) fn reach(parameters: &Parameters) -> Result<f64, ConfigError> {
    let [low_x, low_y, high_x, high_y] = parameters.f64_array("field")?;
    Ok(libm::hypot(high_x - low_x, high_y - low_y).clamp(1e-3, TRENCH_RANGE))
}

fn edge(parameters: &Parameters) -> Result<Edge, ConfigError> {
    Ok(if parameters.bool("zones.continuous")? { Edge::Continuous } else { Edge::Jump })
}

fn sharpness(parameters: &Parameters) -> Result<Sharpness, ConfigError> {
    Ok(if parameters.i64("zones.sharpness")? == 1 { Sharpness::One } else { Sharpness::Two })
}

pub(crate) fn zoning(parameters: &Parameters) -> Result<Option<Zoning>, ConfigError> {
    let [underbar, hat, rho, check, bar] = parameters.f64_array("zones.radii")?;
    let strength = (parameters.f64("zones.repulsion")?, parameters.f64("zones.attraction")?);
    let (sharpness, edge) = (sharpness(parameters)?, edge(parameters)?);
    let full = parameters.f64("zones.full_acceleration")?;
    let radii = Radii::new(underbar, hat, rho, check, bar).ok();
    Ok(radii.and_then(|radii| Zoning::new(radii, strength, sharpness, edge, full).ok()))
}

pub(crate) fn potential_of_obstacles(parameters: &Parameters) -> Result<Option<ObstaclePotential>, ConfigError> {
    let (pole, cut) = (parameters.f64("obstacles.pole")?, parameters.f64("obstacles.cut")?);
    let (strength, full) = (parameters.f64("obstacles.strength")?, parameters.f64("zones.full_acceleration")?);
    Ok(ObstaclePotential::new(pole, cut, strength, sharpness(parameters)?, edge(parameters)?, full).ok())
}
