//! The subcommands.

use clap::Parser;
use std::process::ExitCode;

/// Makes teams of small robots take up and hold formations.
#[derive(Parser)]
#[command(name = "trench", version)]
pub enum Command {}

impl Command {
    /// Runs the subcommand.
    pub fn run(self) -> ExitCode {
        match self {}
    }
}
