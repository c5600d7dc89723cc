//! Parameters of the potentials that keep robots apart, together and off obstacles.

use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_formation::zoning::{Edge, ObstaclePotential, Radii, Sharpness, Zoning};

pub(super) fn descriptors() -> Vec<ParameterDescriptor> {
    use ParameterDescriptor as P;
    vec![
        P::double_list("zones.radii", &[0.20, 0.26, 0.34, 0.45, 1.2], "m, borders of the five zones (Figure 6.1)"),
        P::double("zones.repulsion", 0.001, "m^3/s^2, alpha of Psi_hat").range(1e-9, 1e9),
        P::double("zones.attraction", 0.002, "m^3/s^2, beta of Psi_check").range(1e-9, 1e9),
        P::integer("zones.sharpness", 1, "m of the potentials: 1, alpha/(2 delta); 2, alpha/(2 delta^2)")
            .range(1.0, 2.0),
        P::bool("zones.continuous", true, "forces begin at 0 at the edge of a zone; false: they jump, as printed"),
        P::double("zones.full_acceleration", 0.6, "m/s^2, beyond the poles and at most").range(1e-6, 1e9),
        P::double("obstacles.pole", 0.14, "m, gap between the steered point and an obstacle at the pole")
            .range(0.0, 1e6),
        P::double("obstacles.cut", 0.26, "m, gap at which the repulsion begins").range(0.0, 1e6),
        P::double("obstacles.strength", 0.002, "m^3/s^2").range(1e-9, 1e9),
        P::double("obstacles.clearance", 0.3, "m, robots ahead join hulls that are nearer than this (7.8)")
            .range(0.0, 1e6),
    ]
}

fn edge(parameters: &Parameters) -> Result<Edge, ConfigError> {
    Ok(if parameters.bool("zones.continuous")? { Edge::Continuous } else { Edge::Jump })
}

fn sharpness(parameters: &Parameters) -> Result<Sharpness, ConfigError> {
    Ok(if parameters.i64("zones.sharpness")? == 1 { Sharpness::One } else { Sharpness::Two })
}

pub(super) fn zoning(parameters: &Parameters) -> Result<Zoning, ConfigError> {
    let [underbar, hat, rho, check, bar] = parameters.f64_array("zones.radii")?;
    let remedy = "write rho_underbar < rho_hat < rho < rho_check <= rho_bar, for example [0.20, 0.26, 0.34, 0.45, 1.2]";
    let radii = Radii::new(underbar, hat, rho, check, bar)
        .map_err(|error| parameters.error("zones.radii", error.to_string(), remedy))?;
    let strength = (parameters.f64("zones.repulsion")?, parameters.f64("zones.attraction")?);
    let full = parameters.f64("zones.full_acceleration")?;
    Zoning::new(radii, strength, sharpness(parameters)?, edge(parameters)?, full)
        .map_err(|error| parameters.error("zones.repulsion", error.to_string(), "write a positive number"))
}

pub(super) fn potential(parameters: &Parameters) -> Result<ObstaclePotential, ConfigError> {
    let (pole, cut) = (parameters.f64("obstacles.pole")?, parameters.f64("obstacles.cut")?);
    let (strength, full) = (parameters.f64("obstacles.strength")?, parameters.f64("zones.full_acceleration")?);
    ObstaclePotential::new(pole, cut, strength, sharpness(parameters)?, edge(parameters)?, full)
        .map_err(|error| parameters.error("obstacles.cut", error.to_string(), format!("write more than {pole}")))
}
