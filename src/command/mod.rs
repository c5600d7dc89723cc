//! The subcommands.

mod launch;

use clap::Parser;
use std::process::ExitCode;

/// Makes teams of small robots take up and hold formations.
#[derive(Parser)]
#[command(name = "trench", version)]
pub(crate) enum Command {
    Launch(launch::Arguments),
}

impl Command {
    /// Runs the subcommand.
    pub(crate) fn run(self) -> ExitCode {
        match self {
            Self::Launch(arguments) => launch::run(&arguments),
        }
    }
}
