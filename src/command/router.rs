//! `trench router`: a Zenoh router.

use super::say;
use clap::Args;
use std::env;
use std::os::unix::process::CommandExt;
use std::process::{Command, ExitCode};

/// Where Zenoh takes from how many threads it has, and how many read, open connections, and take them. Zenoh 1.10 closes a connection with what is
/// unsent (SO_LINGER, 10 s): the thread that reads it waits for as long where the other host is gone. There are two by default, so that two
/// sessions of a host that was cut off held up everybody else's messages. Of the others there is one each, which also watches the connections
/// that were made there, and does not while it waits for what they would bring (`trench_runtime::route`).
const THREADS: (&str, &str) =
    ("ZENOH_RUNTIME", "(rx: (worker_threads: 32), net: (worker_threads: 8), acc: (worker_threads: 8))");

/// Runs a Zenoh router, through which ROS 2 processes with RMW_IMPLEMENTATION=rmw_zenoh_cpp find each other.
///
/// One a host is enough, and any other does as well: rmw_zenoh's `rmw_zenohd`, Zenoh's `zenohd`. Listens on TCP port 7447
/// unless ZENOH_ROUTER_CONFIG_URI (a file) or ZENOH_CONFIG_OVERRIDE (key=value, with semicolons between) say otherwise. Reads with
/// 32 threads, and opens and takes connections with 8 each, unless ZENOH_RUNTIME says otherwise: a host that is cut off holds up as many for ten
/// seconds as it has sessions.
#[derive(Args)]
pub(crate) struct Arguments {}

/// Runs it until a signal ends the process.
pub(super) fn run(_: &Arguments) -> ExitCode {
    let (name, threads) = THREADS;
    if env::var_os(name).is_none()
        && let Ok(program) = env::current_exe()
    {
        // Zenoh looks at the environment that the process began with: begin again, as the same process.
        let _failed = Command::new(program).args(env::args_os().skip(1)).env(name, threads).exec();
    }
    let ready = |name: &str, locators: &[String]| say(format!("router {name} listens on {}\n", locators.join(", ")));
    match trench_runtime::route(ready) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("trench router: {error}");
            ExitCode::FAILURE
        }
    }
}
