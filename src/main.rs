//! The `trench` command.
//!
//! Every subcommand is a module of [`command`] with its clap arguments and a `run` that gives the exit code.

mod command;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    command::Command::parse().run()
}
