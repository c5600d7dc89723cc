//! Parameters of the ways out of local minima (7.6, 7.7, Remark 6.4.1).

use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_formation::agent::Remedies;
use trench_formation::avoidance::WatchSettings;

pub(super) fn descriptors() -> Vec<ParameterDescriptor> {
    use ParameterDescriptor as P;
    vec![
        P::bool("remedies.enabled", true, "guards before obstacles (7.6), ways out of hulls (7.7), Remark 6.4.1"),
        P::double("remedies.radius", 0.05, "m, a robot that has not left a disc of this size").range(1e-4, 1e6),
        P::double("remedies.patience", 3.0, "s, for so long, near an obstacle, is caught").range(0.1, 1e6),
        P::double("remedies.arrived", 0.08, "m, unless what draws it is this near").range(1e-4, 1e6),
        P::double("remedies.rising", 0.1, "m/s, at which guards rise and robots are led out of hulls").range(1e-3, 1e6),
        P::bool("remedies.sidesteps", true, "turn pushes straight against the attraction a little to the right"),
    ]
}

/// None where they are switched off.
pub(super) fn remedies(parameters: &Parameters) -> Result<Option<Remedies>, ConfigError> {
    let double = |name: &str| parameters.f64(name);
    let watch = WatchSettings {
        radius: double("remedies.radius")?,
        patience: double("remedies.patience")?,
        arrived: double("remedies.arrived")?,
    };
    let remedies = Remedies { watch, rising: double("remedies.rising")? };
    Ok(parameters.bool("remedies.enabled")?.then_some(remedies))
}
