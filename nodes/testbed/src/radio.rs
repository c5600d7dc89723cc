//! How well the air carries packets, from the parameters.

use trench_config::{ConfigError, Parameters};
use trench_sim::{Bursts, MediumSetup};

/// The air as the parameters `radio.*` have it.
///
/// # Errors
/// The parameter that makes no sense.
pub(crate) fn medium(parameters: &Parameters) -> Result<MediumSetup, ConfigError> {
    let double = |name: &str| parameters.f64(name);
    let or_never = |name: &str| double(name).map(|value| if value > 0.0 { value } else { f64::INFINITY });
    let &[x, y] = parameters.f64_list("radio.antenna")? else {
        return Err(parameters.error("radio.antenna", "is not two numbers", "write x and y in m: [0.0, 0.0]"));
    };
    let medium = MediumSetup {
        delay_min: double("radio.delay_min")?,
        delay_max: double("radio.delay_max")?,
        loss: double("radio.loss")?,
        antenna: [x, y],
        reach_down: or_never("radio.reach.down")?,
        reach_up: or_never("radio.reach.up")?,
        reach_robots: or_never("radio.reach.robots")?,
        bursts: Bursts { every: or_never("radio.bursts.every")?, length: double("radio.bursts.length")? },
    };
    if medium.delay_max < medium.delay_min {
        let remedy = format!("write {} or more", medium.delay_min);
        return Err(parameters.error("radio.delay_max", "is shorter than radio.delay_min", remedy));
    }
    Ok(medium)
}
