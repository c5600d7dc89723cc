//! `trench ssl`: the RoboCup Small Size League's vision packets, out, in and from its logs.

mod log;
mod node;

use clap::{Args, Subcommand, ValueEnum};
use std::net::Ipv4Addr;
use std::process::ExitCode;
use trench_ssl::{GROUP, Team};

const EXIT_CODES: &str = "\
Exit codes of log:
  0  the log is whole
  1  the log is damaged: what is before the damage was read
  2  it is no log

send and receive end with a signal; exit codes as of every node (docs/nodes/runtime.md).";

/// Speaks with the Small Size League's tools: sends our robots as SSL-Vision would, receives what its cameras see, reads its
/// game logs.
///
/// `send` makes the league's tools see our robots. `receive` publishes one team's robots on /overhead/pads, where
/// overhead_localizer with `input: pads` takes them, codes and all (docs/ssl.md).
#[derive(Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// Sends the robots of /team_state as SSL-Vision's detections.
    Send(Link),
    /// Publishes one team of SSL-Vision's detections on /overhead/pads.
    Receive(Link),
    /// Tells what a game log holds.
    Log(log::Arguments),
}

/// Where packets go and come from.
#[derive(Args, Clone)]
struct Link {
    /// The multicast group, or one computer's address.
    #[arg(long, default_value_t = Ipv4Addr::from(GROUP.0))]
    group: Ipv4Addr,
    /// The port.
    #[arg(long, default_value_t = GROUP.1)]
    port: u16,
    /// The address of the network that the group is on; by default the system's choice.
    #[arg(long, default_value_t = Ipv4Addr::UNSPECIFIED)]
    network: Ipv4Addr,
    /// Whose robots are meant.
    #[arg(long, value_enum, default_value = "yellow")]
    team: Colour,
    /// The league's origin, the middle of its field, in the map, m.
    #[arg(long, num_args = 2, value_names = ["X", "Y"], allow_negative_numbers = true, default_values_t = [0.0, 0.0])]
    origin: Vec<f64>,
    /// Further arguments of the node, for example `--ros-args -p use_sim_time:=true`.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    node_arguments: Vec<String>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Colour {
    Yellow,
    Blue,
}

impl From<Colour> for Team {
    fn from(colour: Colour) -> Self {
        match colour {
            Colour::Yellow => Self::Yellow,
            Colour::Blue => Self::Blue,
        }
    }
}

/// Runs the subcommand.
pub(crate) fn run(arguments: &Arguments) -> ExitCode {
    match &arguments.what {
        What::Send(link) => node::run(link, node::Way::Out),
        What::Receive(link) => node::run(link, node::Way::In),
        What::Log(arguments) => log::run(arguments),
    }
}
