//! `trench calibrate`: what a camera's lens does, where it hangs, what the pads' colours are.

mod apply;
mod board;
mod colours;
mod error;
mod field;
mod lens;
mod live;

use clap::{Args, Subcommand};
use error::CalibrateError;
use std::process::ExitCode;
use trench_calibrate::Board;

const EXIT_CODES: &str = "\
Exit codes:
  0  done; files are written
  1  a point does not agree with the others, or the residual is above --accept: files are written all the same
  2  pictures, points or files are not what they should be: nothing is written";

/// Calibrates an overhead camera: print a board, take pictures of it, measure some points, click on two discs.
///
/// `print` makes the board; `lens` finds the lens from ten or more pictures of it; `field` finds where the camera hangs
/// from points whose places are known; `colours` learns the pads' colours, `live` as well, on a page with the
/// camera's picture; `apply` gives a running localizer what was found (docs/calibrate.md).
#[derive(Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    Print(board::Arguments),
    Lens(lens::Arguments),
    Field(field::Arguments),
    Colours(colours::Arguments),
    Live(live::Arguments),
    Apply(apply::Arguments),
}

/// The board, as it is told to `print` and to `lens`.
#[derive(Args, Clone, Copy)]
struct BoardArguments {
    /// Squares along the longer side.
    #[arg(long, default_value_t = 9, value_parser = clap::value_parser!(u16).range(3..=40))]
    columns: u16,
    /// Squares along the shorter side; best another number than columns.
    #[arg(long, default_value_t = 6, value_parser = clap::value_parser!(u16).range(3..=40))]
    rows: u16,
    /// Side of a square, m, as measured on the print.
    #[arg(long, default_value_t = 0.025)]
    square: f64,
}

impl BoardArguments {
    fn board(self) -> Result<Board, CalibrateError> {
        let square = self.square;
        if !(square > 1e-4 && square < 10.0) {
            return Err(CalibrateError::Square(square));
        }
        Ok(Board { columns: self.columns.into(), rows: self.rows.into(), square })
    }
}

/// Runs the subcommand.
pub(crate) fn run(arguments: &Arguments) -> ExitCode {
    let done = match &arguments.what {
        What::Print(arguments) => board::run(arguments),
        What::Lens(arguments) => lens::run(arguments),
        What::Field(arguments) => field::run(arguments),
        What::Colours(arguments) => colours::run(arguments),
        What::Live(arguments) => return live::run(arguments),
        What::Apply(arguments) => return apply::run(arguments),
    };
    match done {
        Ok(agrees) => ExitCode::from(u8::from(!agrees)),
        Err(error) => {
            eprintln!("trench calibrate: {error}");
            ExitCode::from(2)
        }
    }
}
