//! `trench router`: a Zenoh router.

use super::say;
use clap::Args;
use std::process::ExitCode;

/// Runs a Zenoh router, through which ROS 2 processes with RMW_IMPLEMENTATION=rmw_zenoh_cpp find each other.
///
/// One a host is enough, and any other does as well: rmw_zenoh's `rmw_zenohd`, Zenoh's `zenohd`. Listens on TCP port 7447
/// unless ZENOH_ROUTER_CONFIG_URI (a file) or ZENOH_CONFIG_OVERRIDE (key=value, with semicolons between) say otherwise.
#[derive(Args)]
pub(crate) struct Arguments {}

/// Runs it until a signal ends the process.
pub(super) fn run(_: &Arguments) -> ExitCode {
    let ready = |name: &str, locators: &[String]| say(format!("router {name} listens on {}\n", locators.join(", ")));
    match trench_runtime::route(ready) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("trench router: {error}");
            ExitCode::FAILURE
        }
    }
}
