//! `trench check`: configuration against the theory, before anything moves.

mod admit;
mod bed;
mod gather;
mod kind;

use super::say;
use clap::Parser;
use gather::{CheckError, Gathered, gather};
pub(super) use kind::{Kind, kind};
use std::process::ExitCode;
use trench_check::{Report, Verdict, controller, formation, gaps, scenario};

const EXIT_CODES: &str = "\
Exit codes:
  0  every verdict holds
  1  a verdict fails
  2  a file cannot be read as what it is, or a node refuses what it says: file, line, key and remedy are on
     standard error";

/// Judges configuration by the theory, before anything moves: gains, potentials, zones, room, chains.
///
/// Files are formation files, parameter files, launch files, scenario files, in any number: formations are judged for the robots that the
/// other files describe, or else for the controller's defaults. Each verdict names the equation that decides
/// (docs/check.md).
#[derive(Parser)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct Arguments {
    /// Formation, parameter, launch and scenario files, and arguments of the launch files.
    #[arg(required = true, value_name = "FILE | NAME:=VALUE")]
    words: Vec<String>,
    /// Prints the verdicts as JSON.
    #[arg(long)]
    json: bool,
}

/// Runs the subcommand.
pub(crate) fn run(arguments: &Arguments) -> ExitCode {
    match judge(arguments) {
        Ok(report) => {
            if arguments.json {
                say(format_args!("{:#}\n", serde_json::json!(report)));
            } else {
                say(&report);
            }
            ExitCode::from(u8::from(!report.holds))
        }
        Err(error) => {
            eprintln!("trench check: {error}");
            ExitCode::from(2)
        }
    }
}

fn judge(arguments: &Arguments) -> Result<Report, CheckError> {
    let Gathered { controllers, formations, scenarios, team, fields } = gather(&arguments.words)?;
    let mut verdicts: Vec<Verdict> = Vec::new();
    for one in &controllers {
        verdicts.extend(controller(one)?);
    }
    for (name, plan) in &formations {
        verdicts.extend(formation(name, plan, &team));
    }
    for (name, standing, passing) in &fields {
        verdicts.extend(gaps(name, standing, passing));
    }
    for (name, one) in &scenarios {
        verdicts.extend(scenario(name, one));
    }
    Ok(Report::new(verdicts))
}
