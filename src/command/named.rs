//! Launch files that scenarios name: what is wrong with one is told at the scenario's file and line.

use trench_config::ConfigError;
use trench_harness::LoadError;
use trench_scenario::Launch;

/// What a node refuses, as an error of the scenario.
pub(super) fn refused(launch: &Launch, error: &LoadError) -> ConfigError {
    launch.led_to(error.to_string(), error.about())
}
