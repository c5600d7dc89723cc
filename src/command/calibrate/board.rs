//! `trench calibrate print`

use super::BoardArguments;
use super::error::{CalibrateError, write};
use std::path::PathBuf;

/// Draws the chessboard to print, at true scale: print it at 100 %, measure the bar, and glue it onto something flat.
#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    board: BoardArguments,
    /// The file; .svg or .pdf.
    #[arg(long, default_value = "board.pdf")]
    out: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<bool, CalibrateError> {
    let board = arguments.board.board()?;
    let is_svg = arguments.out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg"));
    write(&arguments.out, if is_svg { board.svg().into_bytes() } else { board.pdf() })?;
    Ok(true)
}
