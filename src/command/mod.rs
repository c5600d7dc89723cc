//! The subcommands.

mod bag;
mod calibrate;
mod check;
mod launch;
mod named;
mod plot;
mod report;
mod rounded;
mod router;
mod sim;
mod ssl;
mod stop;
mod view;
mod web;

use clap::Parser;
use std::fmt::Display;
use std::io::Write;
use std::process::ExitCode;

/// Makes teams of small robots take up and hold formations.
#[derive(Parser)]
#[command(name = "trench", version)]
pub(crate) enum Command {
    Bag(bag::Arguments),
    Calibrate(calibrate::Arguments),
    Check(check::Arguments),
    Launch(launch::Arguments),
    Plot(plot::Arguments),
    Report(report::Arguments),
    Router(router::Arguments),
    Sim(sim::Arguments),
    Ssl(ssl::Arguments),
    Stop(stop::Arguments),
    View(view::Arguments),
}

impl Command {
    /// Runs the subcommand.
    pub(crate) fn run(self) -> ExitCode {
        match self {
            Self::Bag(arguments) => bag::run(&arguments),
            Self::Calibrate(arguments) => calibrate::run(&arguments),
            Self::Check(arguments) => check::run(&arguments),
            Self::Launch(arguments) => launch::run(&arguments),
            Self::Plot(arguments) => plot::run(&arguments),
            Self::Report(arguments) => report::run(&arguments),
            Self::Router(arguments) => router::run(&arguments),
            Self::Sim(arguments) => sim::run(&arguments),
            Self::Ssl(arguments) => ssl::run(&arguments),
            Self::Stop(arguments) => stop::run(&arguments),
            Self::View(arguments) => view::run(&arguments),
        }
    }
}

/// Writes to standard output. A reader that has gone (`trench sim ... | head`) is no reason to fail.
pub(crate) fn say(text: impl Display) {
    let _ = write!(std::io::stdout().lock(), "{text}");
}
